#include "harness/report/statement.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

#include "harness/port/profiles.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/claim.hpp"

namespace attest {
namespace {

std::string names_of(const std::vector<std::string>& groups) {
  std::vector<std::string> names;
  for (const std::string& group : groups) names.push_back(one_line(group));
  return fmt::format("{}", fmt::join(names, ", "));
}

// "all groups, with mixer", "groups attitude, tpa and parts of modes", "parts of 16 groups".
std::string which_groups(const Claim& claim) {
  std::string out = "no group";
  if (claim.has_all_groups) {
    out = "all groups";
  } else if (!claim.whole.empty()) {
    out = fmt::format("group{} {}", claim.whole.size() == 1 ? "" : "s", names_of(claim.whole));
  }
  if (!claim.in_part.empty()) {
    constexpr std::size_t most_named = 3;
    const std::size_t count = claim.in_part.size();
    const std::string parts =
        "parts of " + (count > most_named ? counted(count, "group") : names_of(claim.in_part));
    out = claim.whole.empty() ? parts : out + " and " + parts;
  }
  if (!claim.modules.empty()) out += ", with " + names_of(claim.modules);
  return out;
}

// Fixed point has wider tolerances at the numeric level. At the level events, flights and modules
// without events are compared at this level, too.
std::string arithmetic_of(const RunResult& run) {
  const bool is_numeric = run.level == Level::numeric ||
                          std::ranges::any_of(run.results, [](const VectorResult& result) {
                            return result.compared == Level::numeric;
                          });
  if (!run.fraction_bits || !is_numeric) return "";
  return fmt::format(" for fixed point with {} fraction bits", *run.fraction_bits);
}

// "11 rates", or the fixed step of the port.
std::string rate_text(const RunResult& run) {
  if (run.fixed_step) return fmt::format("fixed step of {} Hz", run.fixed_step->to_string());
  return counted(run.rates.size(), "rate");
}

// "px4-v1.16.0", "px4-v1.17 as of v1.17.0-beta1 (2026-01)"
std::string profile_text(const std::string& name) {
  const ProfileInfo* const known = find_profile(name);
  if (known == nullptr || known->as_of.empty()) return one_line(name);
  return fmt::format("{} as of {}", name, known->as_of);
}

// "px4-v1.16.0", "attitude_law, rate_law of px4-v1.16.0"
std::string claimed(const Claim& claim) {
  const std::string profile = profile_text(claim.profile);
  if (!claim.is_of_modules || claim.modules.empty()) return profile;
  return fmt::format("{} of {}", names_of(claim.modules), profile);
}

std::string text_of(const Claim& claim, const RunResult& run) {
  const std::string_view none = name_of(Standing::none);
  const std::string profile = claim.failing.empty() ? claimed(claim) : profile_text(claim.profile);
  if (claim.failing.size() == 1) {
    return fmt::format("{}: {}, a group fails ({})", none, profile, names_of(claim.failing));
  }
  if (!claim.failing.empty()) {
    return fmt::format("{}: {}, {} groups fail ({})", none, profile, claim.failing.size(),
                       names_of(claim.failing));
  }
  std::string what =
      fmt::format("{}, {}{}, {}", profile, name_of(run.level), arithmetic_of(run), rate_text(run));
  if (!claim.is_of_modules) what += ", " + which_groups(claim);
  if (claim.is_complete()) {
    const auto standing = claim.conforms() ? Standing::conformant : Standing::events_agree;
    return fmt::format("{}: {}", name_of(standing), what);
  }
  return fmt::format("{}: {} (because: {})", name_of(Standing::partial), what,
                     one_line(fmt::format("{}", fmt::join(claim.missing, "; "))));
}

// Enough of a hash to distinguish two files; the JSON report has the whole hash.
std::string short_hash(const std::string& sha256) { return sha256.substr(0, 12); }

// Suite, port and date.
std::string subject_of(const RunResult& run) {
  std::string out = fmt::format("cases {}, golden {}", run.cases_version, run.golden_version);
  if (!run.suite_sha256.empty()) {
    out += fmt::format(" ({} suite {})", run.suite_is_released ? "released" : "custom",
                       short_hash(run.suite_sha256));
  }
  if (!run.port.empty()) {
    out += ", port " + (run.port_sha256.empty() ? one_line(run.port) : short_hash(run.port_sha256));
  }
  if (!run.date.empty()) out += ", " + run.date;
  const auto missing = missing_parts(run.limits.barrier);
  if (run.limits.own_process && !missing.empty()) {
    out += fmt::format("; this kernel has no barrier for {}", fmt::join(missing, ", "));
  }
  const auto by_golden = std::count_if(run.results.begin(), run.results.end(),
                                       [](const VectorResult& one) { return one.by_golden; });
  if (by_golden > 0) {
    out += fmt::format("; the golden's values judged {}, because the reference has other bits here",
                       counted(static_cast<std::size_t>(by_golden), "vector"));
  }
  const auto without = std::ranges::count_if(run.results, &VectorResult::no_golden);
  if (without > 0) {
    out += fmt::format("; the reference alone judged {}, because the suite has no golden of {}",
                       counted(static_cast<std::size_t>(without), "vector"),
                       without == 1 ? "it" : "them");
  }
  return out;
}

// "px4-v1.5.5 numeric, fixed point": the last profile with a complete claim. If there is none, the
// last profile with a claim.
std::string on_the_badge(const RunResult& run, Standing standing) {
  std::string profile;
  for (const Claim& claim : claims_of(run)) {
    if (claim.is_complete() || standing == Standing::partial) profile = claimed(claim);
  }
  return fmt::format("{} {}{}{}", profile,
                     standing == Standing::events_agree ? name_of(standing) : name_of(run.level),
                     arithmetic_of(run).empty() ? "" : ", fixed point",
                     standing == Standing::partial ? fmt::format(", {}", name_of(standing)) : "");
}

const char* colour_of(Standing standing) {
  switch (standing) {
    case Standing::conformant:
      return "#3a7d34";
    case Standing::events_agree:
    case Standing::partial:
      return "#8a6500";
    case Standing::none:
      break;
  }
  return "#b3372f";
}

std::string box(int x, int width, const char* colour) {
  return fmt::format(R"(<rect x="{0}" width="{1}" height="20" fill="{2}"/>)"
                     R"(<text x="{3}" y="14" fill="#fff" text-anchor="middle" )"
                     R"(font-family="Verdana,DejaVu Sans,sans-serif" font-size="11"/>)",
                     x, width, colour, x + width / 2);
}

}  // namespace

Statement statement_of(const RunResult& run) {
  const std::string none(name_of(Standing::none));
  const auto claims = claims_of(run);
  const bool fails = std::any_of(claims.begin(), claims.end(),
                                 [](const Claim& claim) { return !claim.failing.empty(); });
  if (!fails && (!run.errors.empty() || run.stopped_early)) {
    return {{none + ": the run is not complete"}, ""};
  }
  if (!fails && run.count(Verdict::pass) == 0) return {{none + ": no vector passed"}, ""};
  Statement statement{{}, subject_of(run)};
  for (const Claim& claim : claims) statement.claims.push_back(text_of(claim, run));
  return statement;
}

std::string conformance_statement(const RunResult& run) {
  const Statement statement = statement_of(run);
  const std::string claims = fmt::format("{}", fmt::join(statement.claims, "; "));
  return statement.subject.empty() ? claims : claims + "; " + statement.subject;
}

std::string badge(const RunResult& run) {
  const bool is_stopped = conclusion_of(run) == Conclusion::stopped;
  const Standing standing = is_stopped ? Standing::partial : standing_of(run);
  const std::string left = "attest";
  const std::string right = is_stopped                   ? std::string(name_of(Conclusion::stopped))
                            : standing == Standing::none ? "does not conform"
                                                         : on_the_badge(run, standing);
  const auto width = [](const std::string& text) { return 7 * static_cast<int>(text.size()) + 10; };
  const int left_width = width(left), right_width = width(right);
  pugi::xml_document document;
  document.load_string(
      fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{}" height="20" role="img" )"
                  R"(aria-label=""><title/>{}{}</svg>)",
                  left_width + right_width, box(0, left_width, "#555"),
                  box(left_width, right_width, colour_of(standing)))
          .c_str());
  const pugi::xml_node svg = document.child("svg");
  svg.attribute("aria-label").set_value((left + ": " + right).c_str());
  svg.child("title").text().set((left + ": " + conformance_statement(run)).c_str());
  svg.find_child_by_attribute("text", "y", "14").text().set(left.c_str());
  svg.last_child().text().set(right.c_str());
  std::ostringstream out;
  document.save(out, "  ", pugi::format_indent | pugi::format_no_declaration);
  return out.str();
}

}  // namespace attest
