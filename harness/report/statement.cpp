#include "harness/report/statement.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

#include "harness/report/text.hpp"

namespace attest {
namespace {

struct GroupState {
  bool passes = false;  // something did
  bool fails = false;
  bool lacks = false;  // something is unsupported, or expected to fail
};

using Groups = std::map<std::string, GroupState>;

Groups groups_of(const RunResult& run) {
  Groups groups;
  for (const std::string& group : run.all_groups) groups[group];
  for (const CaseResult& result : run.results) {
    GroupState& state = groups[result.group];
    state.passes = state.passes || result.verdict == Verdict::pass;
    state.fails = state.fails || fails_a_run(result.verdict);
    state.lacks =
        state.lacks || result.verdict == Verdict::unsupported || result.verdict == Verdict::xfail;
  }
  return groups;
}

template <typename Wanted>
std::vector<std::string> named(const Groups& groups, Wanted wanted) {
  std::vector<std::string> names;
  for (const auto& [name, state] : groups) {
    if (wanted(state)) names.push_back(one_line(name));
  }
  return names;
}

std::string profiles_of(const RunResult& run) {
  std::vector<std::string> profiles;
  for (const CaseResult& result : run.results) {
    const std::string profile = one_line(result.profile);
    if (std::find(profiles.begin(), profiles.end(), profile) == profiles.end()) {
      profiles.push_back(profile);
    }
  }
  return fmt::format("{}", fmt::join(profiles, " and "));
}

std::string which_groups(const Groups& groups) {
  const auto conform = [](const GroupState& state) { return state.passes && !state.lacks; };
  const auto in = named(groups, conform);
  const auto out = named(groups, [&](const GroupState& state) { return !conform(state); });
  if (out.empty()) return "all groups";
  if (out.size() <= in.size()) return fmt::format("all groups but {}", fmt::join(out, ", "));
  return fmt::format("groups {}", fmt::join(in, ", "));
}

void set(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(value.c_str());
}

void add_box(pugi::xml_node svg, int x, int width, const char* colour, const std::string& text) {
  pugi::xml_node box = svg.append_child("rect");
  set(box, "x", fmt::to_string(x));
  set(box, "width", fmt::to_string(width));
  set(box, "height", "20");
  set(box, "fill", colour);
  pugi::xml_node words = svg.append_child("text");
  set(words, "x", fmt::to_string(x + width / 2));
  set(words, "y", "14");
  set(words, "fill", "#fff");
  set(words, "text-anchor", "middle");
  set(words, "font-family", "Verdana,DejaVu Sans,sans-serif");
  set(words, "font-size", "11");
  words.text().set(text.c_str());
}

}  // namespace

std::string conformance_statement(const RunResult& run) {
  const Groups groups = groups_of(run);
  const auto failing = named(groups, [](const GroupState& state) { return state.fails; });
  if (!failing.empty()) {
    return fmt::format(
        "none: {} ({})",
        failing.size() == 1 ? "a group fails" : fmt::format("{} groups fail", failing.size()),
        fmt::join(failing, ", "));
  }
  if (!run.errors.empty() || run.stopped_early) return "none: the run is not complete";
  if (run.count(Verdict::pass) == 0) return "none: nothing was compared";
  return fmt::format("{}, {}, {}, {}; cases {}, golden {}", profiles_of(run), name_of(run.level),
                     counted(run.rates.size(), "rate"), which_groups(groups), run.cases_version,
                     run.golden_version);
}

std::string badge(const RunResult& run) {
  const bool good = run.conformant();
  const std::string left = "attest";
  const std::string right =
      good ? fmt::format("{} {}", profiles_of(run), name_of(run.level)) : "does not conform";
  const auto width = [](const std::string& text) { return 7 * static_cast<int>(text.size()) + 10; };
  pugi::xml_document document;
  pugi::xml_node svg = document.append_child("svg");
  set(svg, "xmlns", "http://www.w3.org/2000/svg");
  set(svg, "width", fmt::to_string(width(left) + width(right)));
  set(svg, "height", "20");
  set(svg, "role", "img");
  set(svg, "aria-label", left + ": " + right);
  svg.append_child("title").text().set((left + ": " + conformance_statement(run)).c_str());
  add_box(svg, 0, width(left), "#555", left);
  add_box(svg, width(left), width(right), good ? "#3a7d34" : "#b3372f", right);
  std::ostringstream out;
  document.save(out, "  ", pugi::format_indent | pugi::format_no_declaration);
  return out.str();
}

}  // namespace attest
