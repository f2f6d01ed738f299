#include "harness/diagnosis/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest {
namespace {

// The share of the deviating values at which a condition must hold: a few may deviate for another
// reason.
constexpr double least_recall = 0.99;
// The largest share of the agreeing values at which it may hold. Above, it separates nothing. Up to
// the larger one, nearly all values must deviate where it holds.
constexpr double few_agreeing = 0.1, most_agreeing = 0.4, least_precision = 0.9;
// The share of all values that agree where it does not hold. With fewer, it holds nearly always.
constexpr double least_outside = 0.2;
// In fewer vectors a condition may hold by chance: one of the law, one of a parameter.
constexpr std::size_t least_vectors = 2, least_vectors_of_parameter = 3;
// Fewer values may have a relation by chance.
constexpr std::size_t least_values = 5;
// Quotients are equal within this, relative.
constexpr double equal_quotients = 2e-3;
// Deviations of at most this share are those of coarse gains or of a table.
constexpr double coarse = 0.02;

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Whether values deviate where the condition holds, and agree elsewhere.
bool separates(const Where& where, const Tally& all) {
  const auto [deviating, agreeing] = where.tally;
  if (share(deviating, all.deviating) < least_recall) return false;
  const std::size_t outside = all.agreeing - agreeing;
  if (share(outside, all.deviating + all.agreeing) < least_outside) return false;
  const bool holds_rarely = share(agreeing, all.agreeing) <= few_agreeing;
  const bool is_precise = share(deviating, deviating + agreeing) >= least_precision;
  switch (where.kind) {
    case ConditionKind::law:
      return true;
    case ConditionKind::input:
      return holds_rarely || is_precise;
    case ConditionKind::parameter:
      return holds_rarely && is_precise;
  }
  return false;
}

// Finds the condition that separates best. `of_parameter`: of those of parameters, or of the
// others.
void find_condition_in(const Observed& observed, bool of_parameter, Pattern& pattern) {
  double smallest = most_agreeing;
  for (const Where& one : observed.where) {
    const bool is_of_parameter = one.kind == ConditionKind::parameter;
    if (is_of_parameter != of_parameter || !separates(one, observed.all)) continue;
    const double agreeing = share(one.tally.agreeing, observed.all.agreeing);
    if (agreeing >= smallest - 1e-3) continue;
    smallest = agreeing;
    pattern.condition = one.condition;
    pattern.kind = one.kind;
  }
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

using Vectors = std::vector<const ObservedVector*>;

void find_condition(const Observed& observed, Pattern& pattern) {
  if (pattern.vectors < least_vectors) return;
  find_condition_in(observed, false, pattern);
  if (!pattern.relation.empty() || !pattern.condition.empty()) return;
  if (pattern.vectors < least_vectors_of_parameter) return;
  find_condition_in(observed, true, pattern);
}

// The pattern of vectors that deviate first in `stage`. Of the others, only vectors of the same
// groups count: other groups differ in more than what makes these vectors deviate.
Pattern pattern_of(FirstStage first, const Vectors& deviating, const Vectors& others) {
  const Stage stage = first.written;
  std::set<int> axes;
  for (const ObservedVector* vector : deviating) {
    for (const auto& [of, observed] : vector->observation) {
      if (of.stage == stage && observed.all.deviating > 0) axes.insert(of.axis);
    }
  }
  Pattern pattern;
  pattern.stage = first.counted;
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
  pattern.relation = relation_in(sum.relations, stage);
  find_condition(sum, pattern);
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
    pattern.condition.clear();
    join(std::move(pattern), joined);
  }
  patterns = std::move(joined);
}

void add_patterns(FirstStage first, const Vectors& deviating, const Vectors& agreeing,
                  std::vector<Pattern>& patterns) {
  Pattern whole = pattern_of(first, deviating, agreeing);
  if (!whole.condition.empty() || !whole.relation.empty() || whole.groups.size() == 1) {
    patterns.push_back(std::move(whole));
    return;
  }
  for (const std::string& group : whole.groups) {
    Vectors of_group;
    for (const ObservedVector* vector : deviating) {
      if (vector->group == group) of_group.push_back(vector);
    }
    join(pattern_of(first, of_group, agreeing), patterns);
  }
  join_relations(patterns);
}

}  // namespace

std::string Pattern::values() const {
  std::string what = relation.empty() ? "deviate" : relation;
  if (!axes.empty()) what = fmt::format("about {} {}", axes, what);
  if (!condition.empty()) what += ", only where " + condition;
  return what;
}

bool Pattern::says_more() const {
  return !relation.empty() || (!condition.empty() && kind != ConditionKind::parameter);
}

std::vector<Pattern> patterns_of(const std::vector<ObservedVector>& vectors) {
  std::map<FirstStage, Vectors> deviating;
  Vectors agreeing;
  for (const ObservedVector& vector : vectors) {
    if (vector.first) {
      deviating[*vector.first].push_back(&vector);
    } else {
      agreeing.push_back(&vector);
    }
  }
  std::vector<Pattern> patterns;
  for (const auto& [first, of_stage] : deviating) {
    add_patterns(first, of_stage, agreeing, patterns);
  }
  const auto order = [](const Pattern& one) {
    return std::tuple(!one.says_more(), one.kind == ConditionKind::parameter,
                      -static_cast<std::ptrdiff_t>(one.vectors));
  };
  std::ranges::stable_sort(patterns, {}, order);
  return patterns;
}

}  // namespace attest
