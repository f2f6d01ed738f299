#include "harness/cli/globals.hpp"

#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/interrupt.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/report/read_report.hpp"

namespace attest::cli {
namespace {

// The vectors of `cases` that failed in a report, and those without which they may pass. Errors:
// the file is no report, or no such vector failed.
Result<std::vector<SelectedCase>> failed_in(const std::string& report,
                                            std::vector<SelectedCase> cases) {
  const auto earlier = read_report(report);
  if (!earlier) return tl::unexpected(earlier.error());
  std::set<std::string> ids;
  for (const VectorResult& result : earlier->results) {
    // What a silent topic has was not compared.
    if (!fails_a_run(result.verdict) && result.silent.empty()) continue;
    ids.insert(result.id());
    ids.insert(result.after.begin(), result.after.end());
  }
  cases = keep_vectors(std::move(cases), ids);
  if (!cases.empty()) return cases;
  return fail_at(report, "no selected vector failed in it; run without --rerun-failed");
}

// The vectors of the files CORE. A line is an id, or begins with #. `are_all`: `cases` are all
// cases of the suite, so all ids must be theirs.
Result<std::vector<SelectedCase>> core_of_suite(const CaseFolders& folders,
                                                std::vector<SelectedCase> cases, bool are_all) {
  std::set<std::string> ids;
  for (const std::filesystem::path& folder : folders) {
    std::istringstream file(read_suite_file(folder / "CORE").value_or(""));
    for (std::string line; std::getline(file, line);) {
      if (!line.empty() && line.front() != '#') ids.insert(line);
    }
  }
  if (ids.empty()) {
    return fail_at((folders.back() / "CORE").string(),
                   "the suite has no core; write this file with `attest faults --core`");
  }
  cases = keep_vectors(std::move(cases), ids);
  for (const auto& [the_case, configurations] : cases) {
    for (const RunConfiguration& one : configurations) ids.erase(the_case.id_at(one));
  }
  if (are_all && !ids.empty()) {
    return fail_at((folders.back() / "CORE").string(),
                   fmt::format("the suite has no vector {}; write this file anew with `attest "
                               "faults --core`",
                               *ids.begin()));
  }
  return cases;
}

// The vectors of the core in open loop, its flights, or both.
Result<std::vector<SelectedCase>> only_asked(std::vector<SelectedCase> core, bool open_loop,
                                             bool flights) {
  std::erase_if(
      core, [&](const SelectedCase& one) { return !(one.the_case.flight ? flights : open_loop); });
  if (!core.empty()) return core;
  return fail(fmt::format("no selected vector is of the core; run without --core{}",
                          flights ? "-flights" : ""));
}

}  // namespace

int report_error(const Error& error) {
  if (interrupted()) {  // a reader may have ended with another message
    const bool says_more = error.message.starts_with("interrupted");
    std::fputs(fmt::format("attest: {}\n", says_more ? error.message : "interrupted").c_str(),
               stderr);
    return exit_interrupted;
  }
  // Not through fmt::print: it throws when stderr cannot be written.
  std::fputs(fmt::format("attest: error: {}\n", error.to_string()).c_str(), stderr);
  return exit_usage;
}

std::string SelectionOptions::narrowing() const {
  auto options = as_options({{"--filter", filters},
                             {"--exclude", excludes},
                             {"--group", groups},
                             {"--rate", rates},
                             {"--vehicle", vehicles},
                             {"--plant", plants}});
  if (core) options.emplace_back("--core");
  if (core_flights) options.emplace_back("--core-flights");
  if (!rerun_failed.empty()) {
    options.push_back(last_failed ? "--last-failed" : "--rerun-failed " + rerun_failed);
  }
  return fmt::format("{}", fmt::join(options, " "));
}

Result<std::vector<LoopRate>> parse_rates(const std::vector<std::string>& texts) {
  std::vector<LoopRate> rates;
  for (const std::string& text : texts) {
    const auto rate = LoopRate::parse(text);
    if (!rate) return tl::unexpected(rate.error());
    rates.push_back(*rate);
  }
  return rates;
}

Result<std::vector<SelectedCase>> SelectionOptions::cases_in(const CaseFolders& folders) const {
  Selection selection;
  selection.filters = filters;
  selection.excludes = excludes;
  selection.groups = groups;
  selection.profiles = profiles;
  selection.vehicles = vehicles;
  selection.plants = plants;
  auto asked = parse_rates(rates);
  if (!asked) return tl::unexpected(asked.error());
  selection.rates = *std::move(asked);
  const auto part = Shard::parse(shard);
  if (!part) return tl::unexpected(part.error());
  selection.shard = *part;
  auto cases = select_cases(folders, selection);
  if (cases && (core || core_flights)) {
    SelectionOptions without_core = *this;
    without_core.core = without_core.core_flights = false;
    cases = core_of_suite(folders, *std::move(cases), without_core.selects_all());
    if (cases) cases = only_asked(*std::move(cases), core, core_flights);
  }
  if (!cases || rerun_failed.empty()) return cases;
  return failed_in(rerun_failed, *std::move(cases));
}

}  // namespace attest::cli
