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
#include "harness/report/fault_table.hpp"
#include "harness/report/progress.hpp"

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
  std::vector<double> hunt;  // the steps of the hunts; empty: none
  std::uint64_t seed = 1;    // of the hunts
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
      return fail(id + ": the table has one fault per line; run two at once as a port: attest " +
                  "run --port fault:" + id);
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

FaultFinding finding_of(const Fault& fault, const std::string& profile, const FaultCatch& found) {
  const auto port = open_fault(fault.id);
  return {&fault, profile, found, caught_by_hover(**port, profile),
          caught_by_random_attitudes(**port, profile)};
}

int verdict(const std::vector<FaultFinding>& findings) {
  const std::vector<std::string> wrong = wrong_of_suite(findings);
  for (const std::string& line : wrong) fmt::print(stderr, "attest: {}\n", line);
  return wrong.empty() ? exit_ok : exit_failed;
}

int diagnose_all(const std::vector<SelectedCase>& cases, const std::string& profile) {
  const std::vector<SelfDiagnosis> results = diagnose_catalogue(cases, profile);
  fmt::print("{}", render_self_diagnoses(results, profile));
  const auto named = std::ranges::count_if(results, &SelfDiagnosis::is_named);
  constexpr double enough = 0.95;
  const bool are_enough =
      static_cast<double>(named) >= enough * static_cast<double>(results.size());
  return are_enough ? exit_ok : exit_failed;
}

// Errors: those of the jobs; an interrupt.
template <typename R>
Result<std::vector<R>> results_of(const Jobs<R>& jobs, int processes, bool is_quiet) {
  Progress progress(jobs.size(), Progress::on_stderr(is_quiet));
  JobOptions<R> workers;
  workers.processes = processes;
  workers.stop = interrupted;
  workers.on_result = [&](const R&) { progress.add(false, ""); };
  return all_results(jobs, workers);
}

Result<void> hunt_faults(const FaultOptions& options, Level level, bool is_quiet,
                         std::vector<FaultFinding>& findings) {
  const double steps = std::min(*std::ranges::max_element(options.hunt), 1e15);
  const auto most = static_cast<std::size_t>(steps);
  Jobs<HuntCatch> jobs;
  for (const FaultFinding& finding : findings) {
    jobs.push_back(std::make_unique<HuntFaultJob>(
        *finding.fault, finding.profile, HuntFaultJob::Options{most, options.seed, level}));
  }
  const auto found = results_of(jobs, options.jobs, is_quiet);
  if (!found) return tl::unexpected(found.error());
  for (std::size_t i = 0; i < findings.size(); ++i) findings[i].hunted = (*found)[i];
  return {};
}

Result<std::optional<Level>> level_of(const FaultOptions& options) {
  if (options.level.empty()) return std::nullopt;
  const auto level = parse_level(options.level);
  if (!level) return tl::unexpected(level.error());
  if (*level != Level::events || options.hunt.empty()) return *level;
  return fail("--level events: a hunt compares values or bits");
}

// Prints which faults are caught. Returns exit_ok if a case of its own group catches each
// detectable fault, and no case catches a fault that is not detectable in the profile. With
// --level: returns exit_ok, because no single level has to catch all. With --hunt: prints also
// which faults the hunts find. With --diagnose: prints which faults are not named, and returns
// exit_ok if at least 95% are named.
Result<int> measure(const FaultOptions& options, const Globals& globals, const SuiteFolder& suite,
                    const std::string& profile, const std::vector<const Fault*>& faults) {
  const auto cases = open_loop_cases(suite, profile);
  if (!cases) return tl::unexpected(cases.error());
  if (options.diagnose) return diagnose_all(*cases, profile);
  const auto level = level_of(options);
  if (!level) return tl::unexpected(level.error());
  const Goldens goldens(suite.golden());
  goldens.origins_of(profile);  // read here, so that the workers have them
  Jobs<FaultCatch> jobs;
  for (const Fault* fault : faults) {
    jobs.push_back(std::make_unique<FaultJob>(*fault, profile, *cases, goldens,
                                              options.fraction_bits, *level));
  }
  const auto caught = results_of(jobs, options.jobs, globals.quiet);
  if (!caught) return tl::unexpected(caught.error());
  std::vector<FaultFinding> findings;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    findings.push_back(finding_of(*faults[i], profile, (*caught)[i]));
  }
  if (!options.hunt.empty()) {
    const auto done =
        hunt_faults(options, level->value_or(Level::numeric), globals.quiet, findings);
    if (!done) return tl::unexpected(done.error());
    fmt::print("{}", render_hunted_faults(findings, {options.hunt.begin(), options.hunt.end()}));
    return *level ? exit_ok : verdict(findings);
  }
  fmt::print("{}", render_fault_table(findings));
  if (!*level) return verdict(findings);
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

// Prints which faults a log of a flight shows, or, if the reference differs from it, which agree.
int faults_of_log(const FaultOptions& options, const Globals& globals,
                  std::vector<const Fault*> faults) {
  if (options.profiles.size() > 1) return report_error({"--profile: name one, for the log"});
  const auto log = read_log(options.log, options.assumed,
                            options.profiles.empty() ? "" : options.profiles.front());
  if (!log) return report_error(log.error());
  print_notes(options.log, log->notes);
  faults = detectable(of_law_of(log->profile, std::move(faults)), {log->profile});
  const auto reference = judge_reference(*log);
  if (!reference) return report_error(reference.error());
  print_notes(options.log, reference->not_judged);
  note_interrupts();
  Jobs<FaultCatch> jobs;
  for (const Fault* fault : faults) {
    jobs.push_back(std::make_unique<LogFaultJob>(*fault, *log, !reference->agrees()));
  }
  const auto caught = results_of(jobs, options.jobs, globals.quiet);
  if (interrupted()) return exit_interrupted;
  if (!caught) return report_error(caught.error());
  std::vector<FaultFinding> findings;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    findings.push_back({faults[i], log->profile, (*caught)[i]});
  }
  fmt::print("{}", render_faults_of_log(options.log, log->profile, *reference, findings));
  return reference->agrees() || reference->any_passes ? exit_ok : exit_failed;
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
  if (!options.log.empty()) return faults_of_log(options, globals, *faults);
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
    const auto code = measure(options, globals, *suite, profile, of_profile);
    if (interrupted()) return exit_interrupted;
    if (!code) return report_error(code.error());
    worst = std::max(worst, *code);
  }
  return worst;
}

void add_hunts(Command command, FaultOptions& options) {
  const Option hunt =
      command
          .option("--hunt", options.hunt,
                  "Also hunt each fault (attest hunt) with so many steps of all modules, and print "
                  "which faults the suite catches and which a hunt finds; several numbers of steps "
                  "are separated by commas")
          .type("STEPS")
          .separated_by_commas()
          .one_each_time()
          .positive();
  for (const char* other : {"--fraction-bits", "--diagnose", "--log", "--core", "--list"}) {
    command.find(other).excludes(hunt);
  }
  command.option("--seed", options.seed, "Another seed makes other trials of the hunts")
      .type("N")
      .whole()
      .shows_default()
      .needs(hunt);
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
              "Measure instead with which faults a port disagrees with the log of a flight")
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
  add_hunts(command, *options);
  add_assumed(command, options->assumed);
  add_jobs(command, options->jobs, "Number of faults that run at the same time");
  command.examples({{"attest faults", "measure which faults the open-loop cases catch"},
                    {"attest faults --level events tpa-missing", "the same at one level"},
                    {"attest faults --core >cases/CORE", "choose the vectors of `run --core`"},
                    {"attest faults --log FLIGHT.ulg", "which mistakes does this flight show?"},
                    {"attest faults --hunt 3e6,18e6 --profile px4-v1.5.5",
                     "compare the suite with hunts of 10 s and 60 s at 300,000 steps/s"},
                    {"attest faults --list --profile px4-v1.3.4",
                     "list the catalogue of one version of the law"}});
  command.runs(options, faults_command);
}

}  // namespace attest::cli
