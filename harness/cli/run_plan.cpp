#include "harness/cli/run_plan.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/find_case.hpp"
#include "harness/cli/released_suite.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/core/version.hpp"
#include "harness/golden/golden.hpp"
#include "harness/host/manifest.hpp"
#include "harness/port/port.hpp"
#include "harness/port/profiles.hpp"
#include "harness/process/child.hpp"
#include "harness/report/read_report.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/recorded_vectors.hpp"

namespace attest::cli {
namespace {

// Stores the port's hash, its description and the profiles that it supports. The port must give the
// same answers during the run. A port that hangs here has no description and is not asked again.
Result<void> ask_port(const std::vector<std::string>& profiles, RunPlan& plan) {
  const auto port = prepare_port(plan.host, profiles);
  if (!port) return tl::unexpected(port.error());
  for (const auto& [profile, words] : port->refusals) {
    if (words.empty()) continue;
    fmt::print(stderr, "attest: note: the port does not support {}; it printed: {}\n", profile,
               one_line(words));
  }
  plan.run.port_name = port->name;
  plan.run.port_version = port->version;
  plan.run.port_modules = port->modules;
  plan.run.fraction_bits = port->fraction_bits;
  plan.run.fixed_step = port->fixed_step;
  plan.run.lacks = port->lacks;
  plan.run.port_sha256 = plan.host.files->sha256();
  plan.run.port_files = port->files;
  return {};
}

// Of a recorded port: checks that its outputs are for the inputs of these cases, and prints how
// many vectors have outputs.
Result<void> check_recorded(const std::vector<SelectedCase>& cases, const RunPlan& plan) {
  if (kind_of(plan.host.port).is_callable() || !plan.host.said) return {};
  const std::string folder = argument_of(plan.host.port);
  const auto found = check_recorded_vectors(folder, *plan.host.said, cases);
  if (!found) return tl::unexpected(found.error());
  fmt::print(stderr, "attest: note: {} of {} selected vectors have outputs in {}\n",
             found->answered, found->selected, folder);
  if (!found->ignored.empty()) {
    fmt::print(stderr, "attest: note: {}: these columns are ignored: {}\n", found->first,
               fmt::join(found->ignored, ", "));
  }
  return {};
}

// Stores the parameters of --param, or those for which the outputs of a recorded port were made.
// Errors: a parameter that no selected case can have; other parameters than those of the recorded
// port; a suite whose reference is a port.
Result<void> set_parameters(const RunOptions& options, const std::vector<SelectedCase>& cases,
                            RunPlan& plan) {
  auto parameters = parse_parameters(options.parameters, cases);
  if (!parameters) return tl::unexpected(parameters.error());
  const std::string folder = argument_of(options.host.port);
  // Without a manifest there is no port, which is found out later.
  if (!kind_of(options.host.port).is_callable() &&
      std::filesystem::exists(std::filesystem::path(folder) / manifest_name)) {
    const auto manifest = read_manifest(folder);
    if (!manifest) return tl::unexpected(manifest.error());
    if (!parameters->empty() && *parameters != manifest->parameters) {
      return fail(
          fmt::format("--param: the outputs in {} are for {}; write inputs with other "
                      "parameters by `attest vectors --param`",
                      folder,
                      manifest->parameters.empty() ? "the parameters of the cases"
                                                   : text_of(manifest->parameters, ", ")));
    }
    for (const ParameterChange& known : manifest->parameters) {
      const std::string text = text_of({&known, 1}, "");
      if (auto accepted = parse_parameters({text}, cases); !accepted) {
        return fail_at((std::filesystem::path(folder) / manifest_name).string(),
                       accepted.error().message);
      }
    }
    *parameters = manifest->parameters;
  }
  if (!plan.run.suite_reference.empty() && !parameters->empty()) {
    return fail(
        "--param: only attest's own law can compute the expected outputs for other parameters, and "
        "the reference of this suite is a port; leave --param out");
  }
  plan.run.parameters = *std::move(parameters);
  return {};
}

// Checks the report of --rerun-failed. Errors: its level or parameters differ from those of this
// run, so other vectors may fail; it contradicts the suite, if it is of the same suite and attest.
Result<void> check_rerun(const RunOptions& options, const SuiteFolder& suite,
                         const RunResult& run) {
  if (options.select.rerun_failed.empty()) return {};
  auto earlier = read_report(options.select.rerun_failed);
  if (!earlier) return tl::unexpected(earlier.error());
  const bool is_of_suite = earlier->suite_sha256 == run.suite_sha256;
  if (is_of_suite && earlier->attest_version == version) {
    const auto cases = select_cases(suite.case_folders(), {});
    if (!cases) return tl::unexpected(cases.error());
    earlier->suite_is_released = run.suite_is_released;
    if (auto checked = check_against(*cases, *earlier, options.select.rerun_failed); !checked) {
      return checked;
    }
  }
  const auto options_of = [](const RunResult& of) {
    return fmt::format("--level {}{}{}", name_of(of.level),
                       of.parameters.empty() ? "" : " --param ",
                       text_of(of.parameters, " --param "));
  };
  if (options_of(*earlier) == options_of(run)) return {};
  return fail_at(options.select.rerun_failed,
                 fmt::format("is of a run with {}, this one is with {}; give the same options",
                             options_of(*earlier), options_of(run)));
}

// Leaves out the cases of profiles of which the port has no module: a port of the controller of
// v1.5.5 is not given the cases of the cascade, unless --profile selects them. Keeps all if none
// would remain.
void leave_out_other_laws(const RunPlan& plan, std::vector<SelectedCase>& cases) {
  if (!plan.host.said) return;
  const auto is_other = [&](const SelectedCase& one) {
    const ProfileInfo* const profile = find_profile(one.the_case.profile);
    return profile && (profile->modules & plan.host.said->modules).none();
  };
  if (!std::all_of(cases.begin(), cases.end(), is_other)) std::erase_if(cases, is_other);
}

// The suite was hashed before its cases were read.
Result<void> check_case(const Case& the_case, const RunPlan& plan) {
  return plan.suite->check(the_case.file, the_case.file_sha256);
}

// Plans the selected cases. Their ticks are those of the case files, not of a recorded timing.
Result<void> plan_cases(const RunOptions& options, const SuiteFolder& suite, RunPlan& plan) {
  auto cases = options.select.cases_in(suite.case_folders());
  if (!cases) return tl::unexpected(cases.error());
  for (const SelectedCase& selected : *cases) {
    if (auto same = check_case(selected.the_case, plan); !same) return same;
  }
  if (auto set = set_parameters(options, *cases, plan); !set) return set;
  if (auto same = check_rerun(options, suite, plan.run); !same) return same;
  if (!plan.run.suite_reference.empty() || !plan.run.parameters.empty()) {
    std::erase_if(*cases, [](const SelectedCase& one) { return one.the_case.flight.has_value(); });
    if (cases->empty())
      return fail(fmt::format("only flights are selected: {}", plan.run.suite_reference.empty()
                                                                   ? "--param leaves them out"
                                                                   : own_law_only));
  }
  std::set<std::string> profiles;
  for (const SelectedCase& selected : *cases) profiles.insert(selected.the_case.profile);
  if (auto asked = ask_port({profiles.begin(), profiles.end()}, plan); !asked) return asked;
  if (options.select.profiles.empty()) leave_out_other_laws(plan, *cases);
  std::set<LoopRate> rates;
  bool all_configurations = true;
  for (const SelectedCase& selected : *cases) {
    all_configurations &=
        selected.configurations.size() == selected.the_case.configurations().size();
    for (const RunConfiguration& configuration : selected.configurations)
      rates.insert(configuration.rate);
    plan.run.selected += selected.configurations.size();
  }
  if (auto checked = check_recorded(*cases, plan); !checked) return checked;
  VehicleModels vehicle_models(suite.models());
  const auto goldens = std::make_shared<const Goldens>(suite.golden(), plan.suite);
  auto jobs = case_jobs(*cases, goldens, vehicle_models,
                        {plan.run.level, options.save_traces, plan.run.parameters, true,
                         judged_by_reference(suite, plan.run.suite_reference)},
                        plan.host);
  if (!jobs) return tl::unexpected(jobs.error());
  plan.jobs = *std::move(jobs);
  plan.run.selection = options.select.narrowing();
  plan.run.all_configurations = all_configurations;
  if (const auto shard = Shard::parse(options.select.shard)) plan.run.shard = *shard;
  plan.run.rates.assign(rates.begin(), rates.end());
  name_files(*cases, *goldens, suite, plan.run);
  plan.cases = std::move(*cases);
  return {};
}

// Plans the one flight of a recorded timing.
Result<void> plan_timed(const RunOptions& options, const SuiteFolder& suite, RunPlan& plan) {
  if (!options.select.selects_all())
    return fail("--timing selects the flight; leave out all other selections");
  if (!options.parameters.empty()) {
    return fail("--timing is a flight, and --param leaves flights out; leave out one of them");
  }
  auto flight = find_timed_flight(options.timing, suite);
  if (!flight) return tl::unexpected(flight.error());
  const bool is_of_suite = plan.suite->has(flight->the_case.file);
  if (is_of_suite) {
    if (auto same = check_case(flight->the_case, plan); !same) return same;
  }
  if (auto asked = ask_port({flight->the_case.profile}, plan); !asked) return asked;
  plan.run.selected = 1;
  plan.run.timing = options.timing;
  name_files({{flight->the_case, {}}}, Goldens(suite.golden(), plan.suite), suite, plan.run);
  plan.run.rates = {flight->timing.configuration.rate};
  plan.jobs.push_back(std::make_unique<TimedJob>(
      std::move(flight->the_case), std::move(flight->timing), std::move(flight->vehicle_model),
      JudgeOptions{plan.run.level, options.save_traces}, plan.host));
  return {};
}

// The date in UTC: that of SOURCE_DATE_EPOCH if it is set, so that reports do not depend on the
// day; else today.
Result<std::string> date_of_run() {
  std::time_t now = std::time(nullptr);
  if (const char* given = std::getenv("SOURCE_DATE_EPOCH"); given && *given) {
    const std::string_view text(given);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), now);
    if (error != std::errc() || end != text.data() + text.size() || now < 0) {
      return fail(fmt::format("SOURCE_DATE_EPOCH is `{}`; it must be a count of seconds", text));
    }
  }
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(now));
}

// Hashes the suite. REQUIRES: the port was not yet started.
Result<void> identify(const SuiteFolder& suite, RunPlan& plan) {
  RunResult& run = plan.run;
  run.cases_version = suite.version_of(suite.cases());
  run.golden_version = suite.version_of(suite.golden());
  auto hash = suite.hash();
  if (!hash) return tl::unexpected(hash.error());
  run.suite_sha256 = hash->sha256;
  run.suite_is_released = run.suite_sha256 == released_suite_sha256();
  if (!run.suite_is_released) run.suite_reference = Goldens(suite.golden()).reference();
  plan.suite = std::make_shared<const FileHashes>(std::move(hash->files));
  run.suite = vectors_by_group(suite, run.suite_sha256);
  return {};
}

// Adds the port, the limits and the date to the run.
Result<void> identify(const RunOptions& options, RunResult& run) {
  run.attest_version = version;
  run.port = options.host.port;
  run.limits = {!options.host.in_process, options.host.timeout_s,
                memory_is_limited() ? std::optional(max_memory_gib) : std::nullopt, max_file_mib,
                barrier_parts()};
  auto date = date_of_run();
  if (!date) return tl::unexpected(date.error());
  run.date = *date;
  return {};
}

Result<ExpectedFailures> read_expected(const std::string& file, const SuiteFolder& suite) {
  const auto cases = select_cases(suite.case_folders(), {});
  if (!cases) return tl::unexpected(cases.error());
  std::vector<std::string> vectors;
  for (const auto& [the_case, configurations] : *cases) {
    if (the_case.flight) continue;
    for (const RunConfiguration& configuration : configurations) {
      vectors.push_back(the_case.id_at(configuration));
    }
  }
  return ExpectedFailures::read(file, vectors);
}

}  // namespace

bool judged_by_reference(const SuiteFolder& suite, const std::string& suite_reference) {
  return suite.base.has_value() && suite_reference.empty();
}

void name_files(const std::vector<SelectedCase>& cases, const Goldens& goldens,
                const SuiteFolder& suite, RunResult& run) {
  const std::filesystem::path golden = path_from_here(suite.golden());
  for (const SelectedCase& selected : cases) {
    const std::string id = selected.the_case.id();
    run.case_files[id] = path_from_here(selected.the_case.file);
    run.whys[id] = selected.the_case.why;
    if (!goldens.has(selected.the_case)) continue;
    run.golden_files[id] = golden_file(golden, key_of(selected.the_case)).string();
  }
}

Result<RunPlan> make_plan(const RunOptions& options, const SuiteFolder& suite) {
  auto level = parse_level(options.level);
  if (!level) return tl::unexpected(level.error());
  RunPlan plan;
  plan.host = options.host;
  plan.host.stop = interrupted;
  plan.run.level = *level;
  if (auto known = identify(suite, plan); !known) return tl::unexpected(known.error());
  if (!options.expected_failures.empty()) {
    auto expected = read_expected(options.expected_failures, suite);
    if (!expected) return tl::unexpected(expected.error());
    plan.expected = std::move(*expected);
  }
  const auto planned =
      options.timing.empty() ? plan_cases(options, suite, plan) : plan_timed(options, suite, plan);
  if (!planned) return tl::unexpected(planned.error());
  if (auto known = identify(options, plan.run); !known) {
    return tl::unexpected(known.error());
  }
  return plan;
}

}  // namespace attest::cli
