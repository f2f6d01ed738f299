#include "harness/diagnosis/hunt.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/hunt_files.hpp"
#include "harness/cli/hunt_progress.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/core/version.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/hunt_document.hpp"
#include "harness/report/report.hpp"
#include "harness/report/text.hpp"

namespace attest::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct HuntCommandOptions {
  HostOptions host;
  std::vector<std::string> profiles, modules;  // empty: all of the port
  std::string level = "numeric";
  std::uint64_t seed = 1;
  std::optional<double> steps, seconds;
  int jobs = 1;
  bool fail_fast = false;
  HuntFiles files;
  std::string json, junit, html;
  bool verbose = false;
};

constexpr double usual_steps = 1e6, most_steps = 1e15;

Result<ModuleSet> modules_of(const HuntCommandOptions& options) {
  ModuleSet chosen;
  for (const std::string& name : options.modules) {
    const auto module = module_named(name);
    if (!module) {
      const auto names = names_of(ModuleSet().set());
      return fail(fmt::format("--module {}: no such module{}; there are {}", name,
                              suggestion(name, {names.begin(), names.end()}),
                              fmt::join(names, ", ")));
    }
    chosen |= only(*module);
  }
  return options.modules.empty() ? ModuleSet().set() : chosen;
}

// The modules of the port in its profiles. Errors: it has none of those that were asked for.
Result<std::vector<ModuleUnderTest>> subjects_of(const HuntCommandOptions& options,
                                                 const PortDescription& port) {
  const auto chosen = modules_of(options);
  if (!chosen) return tl::unexpected(chosen.error());
  std::vector<ModuleUnderTest> subjects;
  for (const ProfileInfo& profile : known_profiles()) {
    const std::string name(profile.name);
    if (std::ranges::find(port.profiles, name) == port.profiles.end()) continue;
    std::ranges::move(subjects_in(profile, port.modules & *chosen), std::back_inserter(subjects));
  }
  if (!subjects.empty()) return subjects;
  return tl::unexpected(
      supported_instead(options.host, options.profiles,
                        [](const std::string& profile, const std::string& with) {
                          return "attest hunt --profile " + profile + with;
                        })
          .value_or(Error{fmt::format("the port {} has no such module in these profiles: {} of {}",
                                      options.host.port, fmt::join(names_of(*chosen), ", "),
                                      fmt::join(options.profiles, ", "))}));
}

struct HuntPlan {
  HuntOptions hunt;
  HostOptions host;
  HuntReport report;
  std::optional<HuntCorpus> corpus;
};

// The hunt begins with the corpus, and then with the logs.
Result<void> add_first(const HuntCommandOptions& options, HuntPlan& plan) {
  if (!options.files.corpus.empty()) {
    auto corpus = open_corpus(options.files.corpus, plan.hunt);
    if (!corpus) return tl::unexpected(corpus.error());
    plan.corpus = *std::move(corpus);
    plan.hunt.first = plan.corpus->inputs();
  }
  // Several profiles: each log says its own.
  const auto& profiles = options.profiles;
  auto of_logs = inputs_of_logs(options.files, profiles.size() == 1 ? profiles.front() : "",
                                plan.hunt, plan.report.notes);
  if (!of_logs) return tl::unexpected(of_logs.error());
  std::ranges::move(*of_logs, std::back_inserter(plan.hunt.first));
  return {};
}

Result<HuntPlan> make_hunt_plan(const HuntCommandOptions& options) {
  HuntPlan plan;
  const auto level = parse_level(options.level);
  if (!level) return tl::unexpected(level.error());
  if (*level == Level::events) return fail("--level events: a hunt compares values or bits");
  if (auto known = check_profiles(options.profiles); !known) return tl::unexpected(known.error());
  plan.host = options.host;
  plan.host.stop = interrupted;
  auto port =
      prepare_port(plan.host, options.profiles.empty() ? known_profile_names() : options.profiles);
  if (!port) return tl::unexpected(port.error());
  for (const std::string& fault : {port->hangs, port->goes_wrong}) {
    if (!fault.empty()) return fail(fmt::format("{}: {}", options.host.port, fault));
  }
  if (port->fraction_bits) {
    return fail(
        "a port in fixed point cannot be hunted: its errors add up, and in random inputs a hunt "
        "cannot tell them from mistakes; `attest run` judges it by its number of fraction bits");
  }
  auto subjects = subjects_of(options, *port);
  if (!subjects) return tl::unexpected(subjects.error());
  plan.hunt.subjects = *std::move(subjects);
  plan.hunt.level = *level;
  plan.hunt.seed = options.seed;
  const double steps = options.steps.value_or(options.seconds ? most_steps : usual_steps);
  plan.hunt.least_steps = static_cast<std::size_t>(std::min(steps, most_steps));
  plan.hunt.fail_fast = options.fail_fast;
  plan.hunt.workers.processes = options.jobs;
  plan.hunt.workers.stop = interrupted;
  RunResult& run = plan.report.run;
  run.attest_version = version;
  run.command = "hunt";
  run.port = options.host.port;
  run.port_name = port->name;
  run.port_version = port->version;
  run.level = *level;
  plan.report.seed = options.seed;
  if (auto added = add_first(options, plan); !added) return tl::unexpected(added.error());
  return plan;
}

// The files of the reports, which are opened before the hunt.
struct HuntReportFiles {
  AtomicFile json, junit, html;

  static Result<HuntReportFiles> open(const HuntCommandOptions& options) {
    auto json = AtomicFile::open(options.json);
    if (!json) return tl::unexpected(json.error());
    auto junit = AtomicFile::open(options.junit);
    if (!junit) return tl::unexpected(junit.error());
    auto html = AtomicFile::open(options.html);
    if (!html) return tl::unexpected(html.error());
    return HuntReportFiles{*std::move(json), *std::move(junit), *std::move(html)};
  }

  Result<void> commit(const HuntReport& report, const Document& document) {
    return json.commit(hunt_json(report))
        .and_then([&] { return junit.commit(junit_report(run_of(report))); })
        .and_then([&] { return html.commit(html_page(document)); });
  }
};

Result<void> check_files(const HuntCommandOptions& options, const Globals& globals) {
  const auto checked = check_outputs({options.json, options.junit, options.html},
                                     {options.host.port, options.files.logs}, globals.suite);
  if (!checked) return checked;
  for (const std::string& folder : {options.files.out, options.files.corpus}) {
    if (folder.empty()) continue;
    if (auto own = check_own_suite(folder); !own) return own;
    if (auto usable = check_may_be_folder(folder); !usable) return usable;
  }
  return {};
}

// Hunts, and adds what was found to the report. True: was interrupted, and reports what was found.
Result<bool> run_hunt(const HuntCommandOptions& options, bool is_quiet, HuntPlan& plan) {
  HuntProgressLine line(is_quiet);
  const auto begin = Clock::now();
  plan.hunt.is_over = [&] {
    const std::chrono::duration<double> passed = Clock::now() - begin;
    return options.seconds && passed.count() >= *options.seconds;
  };
  plan.hunt.on_round = [&](const HuntProgress& now) { line.show(now); };
  if (plan.corpus) {
    plan.hunt.on_new = [&](const std::string& profile, const std::string& toml) {
      return plan.corpus->add(profile, toml);
    };
  }
  bool was_interrupted = false;
  plan.hunt.on_end = [&] {
    line.erase();
    was_interrupted = interrupted();
    if (!was_interrupted) return;
    fmt::print(stderr, "attest: interrupted; shrinking what was found\n");
    forget_interrupt();
  };
  auto found = hunt(plan.hunt, plan.host);
  if (!found) return tl::unexpected(found.error());
  if (auto same = check_port(plan.host); !same) return tl::unexpected(same.error());
  plan.report.found = *std::move(found);
  return was_interrupted;
}

Result<void> keep_findings(const HuntFiles& files, HuntPlan& plan) {
  HuntReport& report = plan.report;
  if (auto written = write_findings(files.out, report); !written) return written;
  if (!plan.corpus) return {};
  if (auto added = add_findings(report.found, *plan.corpus); !added) return added;
  report.notes.push_back(corpus_note(files.corpus, *plan.corpus));
  return {};
}

int hunt_command(const HuntCommandOptions& options, const Globals& globals) {
  note_interrupts();
  if (auto checked = check_files(options, globals); !checked) return report_error(checked.error());
  auto files = HuntReportFiles::open(options);
  if (!files) return report_error(files.error());
  auto plan = make_hunt_plan(options);
  if (!plan) return report_error(plan.error());
  const auto was_interrupted = run_hunt(options, globals.quiet, *plan);
  if (!was_interrupted) return report_error(was_interrupted.error());
  if (auto kept = keep_findings(options.files, *plan); !kept) return report_error(kept.error());
  const HuntReport& report = plan->report;
  const bool has_files = !options.files.out.empty();
  const Document page = hunt_document(report, has_files ? HuntCases::left_out : HuntCases::shown);
  if (auto done = files->commit(report, page); !done) return report_error(done.error());
  const bool is_clean = report.found.findings.empty();
  // In the text, one case is short enough to read; several hide what was found.
  const bool has_cases = options.verbose || (!has_files && report.found.findings.size() == 1);
  const Document text = hunt_document(report, has_cases ? HuntCases::shown : HuntCases::left_out);
  if (!globals.quiet || !is_clean) fmt::print("{}", render_text(text, terminal_style(stdout)));
  if (!globals.quiet) print_hunt_speed(report.found.progress);
  if (*was_interrupted) return exit_interrupted;
  return is_clean ? exit_ok : exit_failed;
}

void add_budget(Command command, HuntCommandOptions& options) {
  command.option("--seed", options.seed, "Another seed makes other trials")
      .type("N")
      .whole()
      .shows_default();
  command
      .option("--steps", options.steps,
              "End after the round in which the port has made so many steps; default: 1000000, "
              "or no limit with --seconds")
      .type("N")
      .positive();
  command
      .option("--seconds", options.seconds,
              "End after the round in which so much time has passed [s]; findings then depend on "
              "the speed of the machine")
      .type("S")
      .positive();
}

void add_first_inputs(Command command, HuntFiles& files) {
  command
      .option("--corpus", files.corpus,
              fmt::format(
                  "Begin with the cases of this suite of yours, and add to it: findings, and "
                  "inputs with which the reference comes nearer to a decision of the law or does "
                  "something else that is new; at most {} cases of a module in a profile",
                  most_of_corpus))
      .type("DIR")
      .group(option_group::selection);
  const Option log = command
                         .option("--log", files.logs,
                                 "Begin with parts of this flight log, too, and vary them; can "
                                 "be given several times")
                         .type("FLIGHT.ulg")
                         .one_each_time()
                         .group(option_group::logs);
  add_assumed(command, files.assumed);
  command.find("--assume").needs(log);
}

void add_hunt_reports(Command command, HuntCommandOptions& options) {
  command
      .option("--out", options.files.out,
              "Write each finding as a case of this suite of yours (group `hunt`), and its inputs "
              "and right outputs as a trace")
      .type("DIR")
      .group(option_group::reports);
  command
      .flag("-v,--verbose", options.verbose,
            "Print the case of each finding; default: if there is one finding, and no --out")
      .group(option_group::reports);
  add_page(command, options.html, "a page with the findings");
  add_json_and_junit(command, options.json, "Write the findings as JSON", options.junit);
}

}  // namespace

void add_hunt(const CommandLine& line) {
  auto options = std::make_shared<HuntCommandOptions>();
  const Command command = line.add(
      "hunt", "Search for inputs on which a port differs from the reference, beyond the suite");
  add_port(command, options->host);
  add_port_argument(command, options->host);
  command
      .option("--profile", options->profiles,
              "Only these versions of the law, separated by commas; default: all of the port")
      .type("PROFILE")
      .separated_by_commas()
      .one_each_time()
      .rewritten(full_profile_name)
      .group(option_group::selection);
  command
      .option("--module", options->modules,
              fmt::format("Only these modules, separated by commas: `{}`; default: all of the port",
                          fmt::join(names_of(ModuleSet().set()), "`, `")))
      .type("MODULE")
      .separated_by_commas()
      .one_each_time()
      .group(option_group::selection);
  command
      .option("--level", options->level,
              "What counts as a difference: `exact` (any bit) or `numeric` (beyond the tolerances, "
              "if rounding cannot explain it)")
      .type("LEVEL")
      .shows_default()
      .group(option_group::strictness);
  add_first_inputs(command, options->files);
  add_budget(command, *options);
  add_jobs(command, options->jobs, "Number of worker processes; does not change the findings");
  command.flag("--fail-fast", options->fail_fast, "End after the round that has the first finding")
      .group(option_group::execution);
  add_timeout(command, options->host.timeout_s);
  add_hunt_reports(command, *options);
  command.examples(
      {{"attest hunt --port lib:./libmine.so", "a million steps of all modules"},
       {"attest hunt --port lib:./libmine.so --module rate_unit --seconds 60 --out ours",
        "search for a minute, and write what is found as cases of the suite `ours`"},
       {"attest hunt --port lib:./libmine.so --level exact --seed 2",
        "look for any other bit, with other trials"},
       {"attest hunt --port lib:./libmine.so --corpus corpus",
        "begin where the last hunt of this folder ended; run it each night"},
       {"attest hunt --port lib:./libmine.so --log flight.ulg",
        "vary what the units received in a flight"}});
  command.runs(options, hunt_command);
}

}  // namespace attest::cli
