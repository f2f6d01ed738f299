#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/read_log.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/diagnosis/core_suite.hpp"
#include "harness/diagnosis/diagnose_catalogue.hpp"
#include "harness/diagnosis/fault_job.hpp"
#include "harness/diagnosis/naive_suite.hpp"
#include "harness/port/fault_port.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/fault_table.hpp"

namespace attest::cli {
namespace {

struct FaultOptions {
  std::vector<std::string> ids;       // empty: all
  std::vector<std::string> profiles;  // empty: all
  bool list = false;
  bool diagnose = false;
  bool core = false;
  std::optional<int> fraction_bits;
  std::string level;  // of all cases; empty: numeric, and exact for cases of that level only
  std::string log;    // of a flight, in place of the suite
  std::vector<std::string> assumed;
  int jobs = 1;
};

using faults::Fault;

Result<std::vector<const Fault*>> chosen(const FaultOptions& options) {
  if (options.ids.empty()) {
    const auto all = faults::catalogue();
    return std::vector<const Fault*>(all.begin(), all.end());
  }
  std::vector<const Fault*> list;
  for (const std::string& id : options.ids) {
    if (auto port = open_fault(id); !port) return tl::unexpected(port.error());
    const Fault* const fault = faults::find_fault(id);
    if (fault == nullptr) {
      return fail(
          fmt::format("{}: the table has one fault per line; run two at once as a port: attest "
                      "run --port fault:{}",
                      id, id));
    }
    list.push_back(fault);
  }
  return list;
}

// Flights catch the same faults as open loop, but take a thousand times as long.
Result<std::vector<SelectedCase>> cases_of(const SuiteFolder& suite, const std::string& profile) {
  Selection selection;
  selection.profiles = {profile};
  return select_cases(suite.case_folders(), selection);
}

Result<std::vector<SelectedCase>> open_loop_cases(const SuiteFolder& suite,
                                                  const std::string& profile) {
  auto cases = cases_of(suite, profile);
  if (!cases) return cases;
  std::erase_if(*cases, [](const SelectedCase& one) { return one.the_case.flight.has_value(); });
  return cases;
}

std::vector<FaultFinding> find_naively(const std::vector<const Fault*>& faults,
                                       const std::string& profile) {
  std::vector<FaultFinding> findings;
  for (const Fault* fault : faults) {
    const auto port = open_fault(fault->id);
    FaultFinding finding;
    finding.fault = fault;
    finding.profile = profile;
    finding.by_hover = caught_by_hover(**port, profile);
    finding.by_random_attitudes = caught_by_random_attitudes(**port, profile);
    findings.push_back(std::move(finding));
  }
  return findings;
}

int verdict(const std::vector<FaultFinding>& findings) {
  const FaultSummary summary = summary_of(findings);
  for (const FaultFinding* finding : summary.survivors) {
    fmt::print(stderr, "attest: survives: {}: {}\n", finding->fault->id, finding->fault->what);
  }
  for (const FaultFinding* finding : summary.not_by_own) {
    fmt::print(stderr, "attest: not caught by its group {}: {}: {}\n", finding->fault->group,
               finding->fault->id, finding->fault->what);
  }
  for (const FaultFinding* finding : summary.false_alarms) {
    fmt::print(stderr, "attest: listed as equivalent, but caught: {} by {}\n", finding->fault->id,
               finding->found.by);
  }
  const bool good =
      summary.survivors.empty() && summary.not_by_own.empty() && summary.false_alarms.empty();
  return good ? exit_ok : exit_failed;
}

// For how many faults the report of most failing vectors names the stage.
void print_stage_lines(const std::vector<SelfDiagnosis>& results, const std::string& profile) {
  const auto count = [&](StageLine line) {
    return std::count_if(results.begin(), results.end(), [line](const SelfDiagnosis& result) {
      return !result.stage_lines.empty() && result.usual_stage_line() == line;
    });
  };
  for (const SelfDiagnosis& result : results) {
    const auto& lines = result.stage_lines;
    if (lines.empty() || result.usual_stage_line() != StageLine::wrong) continue;
    fmt::print("{}: most reports do not name the stage {}\n", result.fault->id,
               name_of(result.fault->stage));
  }
  fmt::print(
      "{}: \"look first at\" names the stage of {} faults; of {} more, whose stage has no output, "
      "it names a later stage; of {} another stage\n",
      profile, count(StageLine::own), count(StageLine::later), count(StageLine::wrong));
}

int diagnose_all(const std::vector<SelectedCase>& cases, const std::string& profile) {
  const std::vector<SelfDiagnosis> results = diagnose_catalogue(cases, profile);
  std::size_t named = 0, stages = 0;
  for (const SelfDiagnosis& result : results) {
    named += result.is_named() ? 1 : 0;
    stages += result.is_stage_named() ? 1 : 0;
    if (result.is_named()) continue;
    fmt::print(
        "{} is not named; the diagnosis is:\n{}", result.fault->id,
        result.diagnosis ? diagnosis_text(*result.diagnosis) : "no deviation from the law\n");
  }
  const double part = 100 * static_cast<double>(named) / static_cast<double>(results.size());
  fmt::print(
      "{}: {} of {} faults are named first, alone or with faults that match equally well "
      "({:.1f}%); the stage of {} is named\n",
      profile, named, results.size(), part, stages);
  print_stage_lines(results, profile);
  constexpr double enough = 95;
  return part >= enough ? exit_ok : exit_failed;
}

JobResults<FaultCatch> catches_of(const Jobs<FaultCatch>& jobs, const FaultOptions& options) {
  JobOptions<FaultCatch> workers;
  workers.processes = options.jobs;
  workers.stop = interrupted;
  return run_jobs(jobs, workers);
}

// Prints which faults are caught. Returns exit_ok if a case of its own group catches each
// detectable fault, and no case catches a fault that is not detectable in the profile. With
// --level: returns exit_ok, because no single level has to catch all. With --diagnose: prints which
// faults are not named, and returns exit_ok if at least 95% are named.
Result<int> measure(const FaultOptions& options, const SuiteFolder& suite,
                    const std::string& profile, const std::vector<const Fault*>& faults) {
  const auto cases = open_loop_cases(suite, profile);
  if (!cases) return tl::unexpected(cases.error());
  if (options.diagnose) return diagnose_all(*cases, profile);
  std::optional<Level> level;
  if (!options.level.empty()) {
    const auto parsed = parse_level(options.level);
    if (!parsed) return tl::unexpected(parsed.error());
    level = *parsed;
  }
  const Goldens goldens(suite.golden());
  goldens.origins_of(profile);  // read here, so that the workers have them
  Jobs<FaultCatch> jobs;
  for (const Fault* fault : faults) {
    jobs.push_back(
        std::make_unique<FaultJob>(*fault, profile, *cases, goldens, options.fraction_bits, level));
  }
  const JobResults<FaultCatch> outcome = catches_of(jobs, options);
  if (interrupted()) return exit_interrupted;
  if (!outcome.errors.empty()) return tl::unexpected(outcome.errors.front());
  std::vector<FaultFinding> findings = find_naively(faults, profile);
  for (std::size_t i = 0; i < findings.size(); ++i) findings[i].found = outcome.results[i];
  fmt::print("{}", render_fault_table(findings));
  if (!level) return verdict(findings);
  const FaultSummary summary = summary_of(findings);
  fmt::print("{}, level {}: {} of {} detectable faults are caught\n", profile, options.level,
             summary.caught, summary.detectable);
  return exit_ok;
}

// The faults of the profile's law.
std::vector<const Fault*> of_law_of(const std::string& profile, std::vector<const Fault*> faults) {
  std::erase_if(faults,
                [&](const Fault* fault) { return !fault->profiles->is_of_law_of(profile); });
  return faults;
}

// The requested profiles; by default all profiles of the laws to which the faults belong.
Result<std::vector<std::string>> chosen_profiles(const FaultOptions& options,
                                                 const std::vector<const Fault*>& faults) {
  if (auto known = check_profiles(options.profiles); !known) return tl::unexpected(known.error());
  if (!options.profiles.empty()) return options.profiles;
  std::vector<std::string> profiles = known_profile_names();
  std::erase_if(profiles, [&](const std::string& name) { return of_law_of(name, faults).empty(); });
  return profiles;
}

// The faults that differ from the law in at least one of `profiles`.
std::vector<const Fault*> detectable(std::vector<const Fault*> faults,
                                     const std::vector<std::string>& profiles) {
  std::erase_if(faults, [&](const Fault* fault) {
    return std::none_of(profiles.begin(), profiles.end(),
                        [&](const std::string& profile) { return fault->is_detectable(profile); });
  });
  return faults;
}

// Prints which faults a log of a flight shows.
int faults_of_log(const FaultOptions& options, std::vector<const Fault*> faults) {
  if (options.profiles.size() > 1) return report_error({"--profile: name one, for the log"});
  const auto log = read_log(options.log, options.assumed,
                            options.profiles.empty() ? "" : options.profiles.front());
  if (!log) return report_error(log.error());
  print_notes(options.log, log->notes);
  faults = detectable(of_law_of(log->profile, std::move(faults)), {log->profile});
  note_interrupts();
  Jobs<FaultCatch> jobs;
  for (const Fault* fault : faults) jobs.push_back(std::make_unique<LogFaultJob>(*fault, *log));
  const JobResults<FaultCatch> outcome = catches_of(jobs, options);
  if (interrupted()) return exit_interrupted;
  if (!outcome.errors.empty()) return report_error(outcome.errors.front());
  std::vector<FaultFinding> findings;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    findings.push_back({faults[i], log->profile, outcome.results[i]});
  }
  fmt::print("{}", render_faults_of_log(options.log, log->profile, findings));
  return exit_ok;
}

// Prints the file cases/CORE: the core of each profile.
int print_core(const FaultOptions& options, const SuiteFolder& suite,
               const std::vector<std::string>& profiles) {
  fmt::print(
      "# The core of the suite: few vectors that catch every fault that all vectors catch at the\n"
      "# level numeric, for each module of its own, and few flights that catch what flights do.\n"
      "# `attest faults --core` prints this file.\n");
  const Goldens goldens(suite.golden());
  VehicleModels models(suite.models());
  for (const std::string& profile : profiles) {
    const auto cases = cases_of(suite, profile);
    if (!cases) return report_error(cases.error());
    const auto cores = core_of(*cases, profile, goldens, models, {options.jobs, interrupted});
    if (interrupted()) return exit_interrupted;
    if (!cores) return report_error(cores.error());
    for (const CoreOfModule& core : *cores) {
      if (core.vectors.empty()) continue;
      fmt::print("\n# {}, {}: {} faults, {} vectors, {} ticks\n{}\n", profile,
                 core.flights ? "flights" : name_of(core.module), core.faults, core.vectors.size(),
                 core.ticks, fmt::join(core.vectors, "\n"));
    }
  }
  return exit_ok;
}

int faults_command(const FaultOptions& options, const Globals& globals) {
  const auto faults = chosen(options);
  if (!faults) return report_error(faults.error());
  if (!options.log.empty()) return faults_of_log(options, *faults);
  const auto profiles = chosen_profiles(options, *faults);
  if (!profiles) return report_error(profiles.error());
  if (options.list) {
    fmt::print("{}", render_fault_list(options.profiles.empty() ? *faults
                                                                : detectable(*faults, *profiles)));
    return exit_ok;
  }
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  note_interrupts();
  if (options.core) return print_core(options, *suite, *profiles);
  int worst = exit_ok;
  for (const std::string& profile : *profiles) {
    if (&profile != &profiles->front()) fmt::print("\n");
    if (!options.diagnose) fmt::print("### {}\n\n", profile);
    const auto of_profile = options.ids.empty() ? of_law_of(profile, *faults) : *faults;
    const auto code = measure(options, *suite, profile, of_profile);
    if (!code) return report_error(code.error());
    if (*code == exit_interrupted) return *code;
    worst = std::max(worst, *code);
  }
  return worst;
}

}  // namespace

void add_faults(const CommandLine& line) {
  auto options = std::make_shared<FaultOptions>();
  const Command command =
      line.add("faults", "Measure which faults of the catalogue the suite catches");
  const Option ids =
      command.option("fault", options->ids, "Only these faults; default: all").type("ID");
  command
      .option("--profile", options->profiles,
              "Only these versions of the law, separated by commas; default: all")
      .type("PROFILE")
      .separated_by_commas()
      .one_each_time()
      .rewritten(full_profile_name);
  command.flag("--list", options->list, "List the faults, and run nothing");
  const Option bits =
      command
          .option("--fraction-bits", options->fraction_bits,
                  "Use the tolerances of a port in fixed point with this number of fraction "
                  "bits; default: those of floating point")
          .range(fewest_fraction_bits, most_fraction_bits);
  const Option level =
      command
          .option("--level", options->level,
                  "Judge all cases at this level, exact, numeric or events, and print how many "
                  "faults it catches; default: numeric, and exact for the cases that are "
                  "compared at that level only")
          .type("LEVEL");
  command
      .flag("--diagnose", options->diagnose,
            "Measure instead which faults the diagnosis names, and for which the reports name the "
            "stage")
      .excludes(bits)
      .excludes(ids)
      .excludes(level);
  command
      .option("--log", options->log,
              "Measure instead which faults the log of a flight shows: those with which a port "
              "does not agree with it")
      .type("FLIGHT.ulg")
      .excludes(bits)
      .excludes(level);
  command
      .flag("--core", options->core,
            "Print the core of the suite instead, the file cases/CORE: few vectors that catch the "
            "same faults at the level numeric")
      .excludes(bits)
      .excludes(ids)
      .excludes(level);
  add_assumed(command, options->assumed);
  add_jobs(command, options->jobs, "Number of faults that run at the same time");
  command.examples({{"attest faults", "measure which faults the open-loop cases catch"},
                    {"attest faults --level events tpa-missing", "the same at one level"},
                    {"attest faults --core >cases/CORE", "choose the vectors of `run --core`"},
                    {"attest faults --log FLIGHT.ulg", "which mistakes does this flight show?"},
                    {"attest faults --list --profile px4-v1.3.4",
                     "list the catalogue of one version of the law"}});
  command.runs(options, faults_command);
}

}  // namespace attest::cli
