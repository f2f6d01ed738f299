#include "harness/diagnosis/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest {
namespace {

// The share of the deviating values at which a condition must hold: a few may deviate for another
// reason.
constexpr double least_recall = 0.99;
// The largest share of the agreeing values at which it may hold. Above, it separates nothing.
constexpr double most_agreeing = 0.4;
// In fewer vectors a condition may hold by chance.
constexpr std::size_t least_vectors = 2;
// Fewer values may have a relation by chance.
constexpr std::size_t least_values = 5;
// Quotients are equal within this, relative.
constexpr double equal_quotients = 2e-3;
// Deviations of at most this share are those of coarse gains or of a table.
constexpr double coarse = 0.02;

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::string condition_in(const Observed& observed) {
  std::string best;
  double smallest = most_agreeing;
  for (const auto& [text, tally] : observed.where) {
    if (share(tally.deviating, observed.all.deviating) < least_recall) continue;
    const double agreeing = share(tally.agreeing, observed.all.agreeing);
    if (agreeing >= smallest - 1e-3) continue;
    smallest = agreeing;
    best = text;
  }
  return best;
}

std::string relation_in(const Relations& r, Stage stage) {
  const auto nearly_all = [&](std::size_t count) { return share(count, r.values) >= least_recall; };
  if (r.values < least_values) return {};
  if (nearly_all(r.cleared)) return "are 0 where the topic is not published: the port clears them";
  if (nearly_all(r.late)) return "are those of the step before";
  if (nearly_all(r.reversed)) return "have the other sign";
  if (nearly_all(r.zero)) return "are 0";
  if (nearly_all(r.smaller) && r.smaller_to - r.smaller_from <= equal_quotients * r.smaller_to) {
    return fmt::format("are limited to {:.4g}", r.smaller_to);
  }
  if (r.quotients < least_values) return {};
  const double middle = (r.quotient_from + r.quotient_to) / 2;
  if (std::abs(middle) < equal_quotients) {
    return stage == Stage::integrator && nearly_all(r.quotients) ? "do not change" : "";
  }
  const double width = r.quotient_to - r.quotient_from;
  if (width <= equal_quotients * std::abs(middle)) {
    return stage == Stage::integrator
               ? fmt::format("change {:.4g} times as much as they should: a wrong dt or gain",
                             middle)
               : fmt::format("are {:.5g} times those expected", middle);
  }
  const double largest = std::max(std::abs(r.quotient_from - 1), std::abs(r.quotient_to - 1));
  if (largest <= coarse && share(r.quotients, r.values) >= 0.5) {
    return fmt::format("differ by at most {:.2g}%: coarse gains, a table or a low precision",
                       100 * largest);
  }
  return {};
}

std::string names_of_axes(const std::set<int>& axes) {
  constexpr const char* names[] = {"roll", "pitch", "yaw"};
  std::vector<std::string> list;
  for (const int axis : axes) {
    if (axis >= 0) list.push_back(names[axis]);
  }
  if (list.size() == 3 || list.size() < axes.size()) return {};
  return fmt::format("{}", fmt::join(list, " and "));
}

// The first stage in which a vector deviates.
std::optional<Stage> stage_in(const Observation& observation) {
  for (const auto& [of, observed] : observation) {
    if (observed.all.deviating > 0) return of.stage;
  }
  return std::nullopt;
}

using Vectors = std::vector<const ObservedVector*>;

// The pattern of vectors that deviate first in `stage`. Of the others, only vectors of the same
// groups count: other groups differ in more than what makes these vectors deviate.
Pattern pattern_of(Stage stage, const Vectors& deviating, const Vectors& others) {
  std::set<int> axes;
  for (const ObservedVector* vector : deviating) {
    for (const auto& [of, observed] : vector->observation) {
      if (of.stage == stage && observed.all.deviating > 0) axes.insert(of.axis);
    }
  }
  Pattern pattern;
  pattern.stage = stage;
  pattern.axes = names_of_axes(axes);
  pattern.vectors = deviating.size();
  Observed sum;
  const auto add = [&](const ObservedVector& vector) {
    for (const int axis : axes) {
      const auto found = vector.observation.find({stage, axis});
      if (found != vector.observation.end()) sum.add(found->second);
    }
  };
  std::set<std::string> groups;
  for (const ObservedVector* vector : deviating) {
    add(*vector);
    groups.insert(vector->group);
  }
  pattern.groups.assign(groups.begin(), groups.end());
  for (const ObservedVector* vector : others) {
    if (groups.contains(vector->group)) add(*vector);
  }
  if (deviating.size() >= least_vectors) pattern.condition = condition_in(sum);
  pattern.relation = relation_in(sum.relations, stage);
  return pattern;
}

void join(Pattern pattern, std::vector<Pattern>& patterns) {
  for (Pattern& known : patterns) {
    if (known.stage != pattern.stage || known.condition != pattern.condition ||
        known.relation != pattern.relation) {
      continue;
    }
    if (known.axes != pattern.axes) known.axes.clear();
    known.vectors += pattern.vectors;
    known.groups.insert(known.groups.end(), pattern.groups.begin(), pattern.groups.end());
    return;
  }
  patterns.push_back(std::move(pattern));
}

// Patterns of one relation have one cause: without conditions that differ, they are one.
void join_relations(std::vector<Pattern>& patterns) {
  std::vector<Pattern> joined;
  for (Pattern& pattern : patterns) {
    const auto known = std::find_if(joined.begin(), joined.end(), [&](const Pattern& one) {
      return !one.relation.empty() && one.stage == pattern.stage &&
             one.relation == pattern.relation;
    });
    if (known == joined.end()) {
      joined.push_back(std::move(pattern));
      continue;
    }
    known->condition.clear();
    join({known->stage, pattern.axes, known->relation, "", pattern.vectors, pattern.groups},
         joined);
  }
  patterns = std::move(joined);
}

void add_patterns(Stage stage, const Vectors& deviating, const Vectors& agreeing,
                  std::vector<Pattern>& patterns) {
  Pattern whole = pattern_of(stage, deviating, agreeing);
  if (!whole.condition.empty() || !whole.relation.empty() || whole.groups.size() == 1) {
    patterns.push_back(std::move(whole));
    return;
  }
  for (const std::string& group : whole.groups) {
    Vectors of_group;
    for (const ObservedVector* vector : deviating) {
      if (vector->group == group) of_group.push_back(vector);
    }
    join(pattern_of(stage, of_group, agreeing), patterns);
  }
  join_relations(patterns);
}

}  // namespace

std::vector<Pattern> patterns_of(const std::vector<ObservedVector>& vectors) {
  std::map<Stage, Vectors> deviating;
  Vectors agreeing;
  for (const ObservedVector& vector : vectors) {
    const auto stage = stage_in(vector.observation);
    if (stage) {
      deviating[*stage].push_back(&vector);
    } else {
      agreeing.push_back(&vector);
    }
  }
  std::vector<Pattern> patterns;
  for (const auto& [stage, of_stage] : deviating) {
    add_patterns(stage, of_stage, agreeing, patterns);
  }
  std::stable_sort(patterns.begin(), patterns.end(),
                   [](const Pattern& a, const Pattern& b) { return a.vectors > b.vectors; });
  return patterns;
}

}  // namespace attest
