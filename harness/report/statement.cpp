#include "harness/report/statement.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

#include "harness/report/text.hpp"
#include "harness/report/xml.hpp"

namespace attest {
namespace {

struct GroupState {
  bool passes = false;  // something did
  bool fails = false;
  bool lacks = false;  // something is unsupported, or expected to fail

  bool conforms() const { return passes && !fails && !lacks; }
};

using Groups = std::map<std::string, GroupState>;

// By profile, then group.
std::map<std::string, Groups> groups_of(const RunResult& run) {
  std::map<std::string, Groups> profiles;
  for (const std::string& name : run.all_groups) {
    const std::size_t slash = name.find('/');
    profiles[name.substr(0, slash)][name.substr(slash + 1)];
  }
  for (const CaseResult& result : run.results) {
    GroupState& state = profiles[result.profile][result.group];
    state.passes = state.passes || result.verdict == Verdict::pass;
    state.fails = state.fails || fails_a_run(result.verdict);
    // A port with a fixed step conforms at that rate, and the statement says so.
    const bool is_of_another_step = run.fixed_step && result.rate != *run.fixed_step &&
                                    result.reason.find("fixed step") != std::string::npos;
    state.lacks = state.lacks || result.verdict == Verdict::xfail ||
                  (result.verdict == Verdict::unsupported && !is_of_another_step);
  }
  return profiles;
}

template <typename Wanted>
std::vector<std::string> named(const Groups& groups, Wanted wanted) {
  std::vector<std::string> names;
  for (const auto& [name, state] : groups) {
    if (wanted(state)) names.push_back(one_line(name));
  }
  return names;
}

std::vector<std::string> failing_groups(const RunResult& run) {
  std::vector<std::string> all;
  for (const auto& [profile, groups] : groups_of(run)) {
    for (const std::string& name :
         named(groups, [](const GroupState& state) { return state.fails; })) {
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
  }
  return all;
}

std::string which_groups(const Groups& groups) {
  const auto in = named(groups, [](const GroupState& state) { return state.conforms(); });
  const auto out = named(groups, [](const GroupState& state) { return !state.conforms(); });
  if (out.empty()) return "all groups";
  if (out.size() <= in.size()) return fmt::format("all groups but {}", fmt::join(out, ", "));
  return fmt::format("group{} {}", in.size() == 1 ? "" : "s", fmt::join(in, ", "));
}

// Where allowances were made for it: at the numeric level, and for flights at all.
std::string arithmetic_of(const RunResult& run) {
  const bool flew = std::any_of(run.results.begin(), run.results.end(),
                                [](const CaseResult& result) { return result.flyer.has_value(); });
  if (!run.fraction_bits || (run.level != Level::numeric && !flew)) return "";
  return fmt::format(" for fixed point with {} fraction bits", *run.fraction_bits);
}

// "11 rates", or the one that the port has.
std::string rates_of(const RunResult& run) {
  if (run.fixed_step) return fmt::format("fixed step of {} Hz", run.fixed_step->to_string());
  return counted(run.rates.size(), "rate");
}

// Of the profiles in which some group conforms.
std::vector<std::string> statements_of(const RunResult& run) {
  std::vector<std::string> statements;
  for (const auto& [profile, groups] : groups_of(run)) {
    const bool some = std::any_of(groups.begin(), groups.end(),
                                  [](const auto& group) { return group.second.conforms(); });
    if (!some) continue;
    statements.push_back(fmt::format("{}, {}{}, {}, {}", one_line(profile), name_of(run.level),
                                     arithmetic_of(run), rates_of(run), which_groups(groups)));
  }
  return statements;
}

// Of the law that most ports are of, when it is among them.
std::string profile_of(const RunResult& run) {
  std::string last;
  for (const auto& [profile, groups] : groups_of(run)) {
    if (!named(groups, [](const GroupState& state) { return state.passes; }).empty()) {
      last = one_line(profile);
    }
  }
  return last;
}

void add_box(pugi::xml_node svg, int x, int width, const char* colour, const std::string& text) {
  pugi::xml_node box = svg.append_child("rect");
  set_attribute(box, "x", fmt::to_string(x));
  set_attribute(box, "width", fmt::to_string(width));
  set_attribute(box, "height", "20");
  set_attribute(box, "fill", colour);
  pugi::xml_node words = svg.append_child("text");
  set_attribute(words, "x", fmt::to_string(x + width / 2));
  set_attribute(words, "y", "14");
  set_attribute(words, "fill", "#fff");
  set_attribute(words, "text-anchor", "middle");
  set_attribute(words, "font-family", "Verdana,DejaVu Sans,sans-serif");
  set_attribute(words, "font-size", "11");
  words.text().set(text.c_str());
}

}  // namespace

std::string conformance_statement(const RunResult& run) {
  const auto failing = failing_groups(run);
  if (failing.size() == 1) return fmt::format("none: a group fails ({})", failing.front());
  if (!failing.empty()) {
    return fmt::format("none: {} groups fail ({})", failing.size(), fmt::join(failing, ", "));
  }
  if (!run.errors.empty() || run.stopped_early) return "none: the run is not complete";
  const auto statements = statements_of(run);
  if (statements.empty()) return "none: no group passes as a whole";
  return fmt::format("{}; cases {}, golden {}", fmt::join(statements, "; "), run.cases_version,
                     run.golden_version);
}

std::string badge(const RunResult& run) {
  const bool good = run.conformant();
  const std::string left = "attest";
  const std::string right = good ? fmt::format("{} {}{}", profile_of(run), name_of(run.level),
                                               arithmetic_of(run).empty() ? "" : ", fixed point")
                                 : "does not conform";
  const auto width = [](const std::string& text) { return 7 * static_cast<int>(text.size()) + 10; };
  pugi::xml_document document;
  pugi::xml_node svg = document.append_child("svg");
  set_attribute(svg, "xmlns", "http://www.w3.org/2000/svg");
  set_attribute(svg, "width", fmt::to_string(width(left) + width(right)));
  set_attribute(svg, "height", "20");
  set_attribute(svg, "role", "img");
  set_attribute(svg, "aria-label", left + ": " + right);
  svg.append_child("title").text().set((left + ": " + conformance_statement(run)).c_str());
  add_box(svg, 0, width(left), "#555", left);
  add_box(svg, width(left), width(right), good ? "#3a7d34" : "#b3372f", right);
  std::ostringstream out;
  document.save(out, "  ", pugi::format_indent | pugi::format_no_declaration);
  return out.str();
}

}  // namespace attest
