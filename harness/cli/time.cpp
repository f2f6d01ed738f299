#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "harness/cli/exchange_note.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/stdout_diversion.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/host/step_timer.hpp"
#include "harness/measure/vector_times.hpp"
#include "harness/realtime/instructions.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/time_document.hpp"

namespace attest::cli {
namespace {

struct TimeCommandOptions {
  SelectionOptions select;
  HostOptions host;
  TimeOptions measure;
  int allowed = 0;  // number of steps that may be over the budget
  bool instructions = false;
  std::optional<double> clock_hz;  // in place of the one that the port declares
  std::string budget_file, write_budget_file;
  double growth_percent = 0;  // over the budget file, allowed
  std::string html, json;
};

// The open-loop cases of units and laws. Flights are left out: their steps cannot be repeated
// without a new flight, and do not differ in kind from those in open loop.
Result<std::vector<SelectedCase>> open_loop_cases(const TimeCommandOptions& options,
                                                  const SuiteFolder& suite) {
  auto cases = options.select.cases_in(suite.case_folders());
  if (!cases) return cases;
  std::erase_if(*cases, [](const SelectedCase& one) {
    return one.the_case.flight || !info_of(one.the_case.module).has_law();
  });
  if (cases->empty())
    return fail("no open-loop case of a unit or law is selected, and only these can be timed");
  return cases;
}

// A bound for callgrind, including its start; measured factors are 50 to 100.
constexpr double counting_is_slower_by = 100;

// Runs this program again under callgrind, on the vector `id` only. Returns the instructions of
// each step; empty: not counted.
std::vector<std::uint64_t> counted(const TimeCommandOptions& options, const SuiteFolder& suite,
                                   const std::string& id) {
  std::error_code ignored;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  auto counts = instructions_of_calls(
      {self.string(), "--suite", suite.root.string(), "--quiet", "time", "--port",
       options.host.port, "--filter", id, "--repeat", "1", "--no-stack", "--in-process"},
      counted_step_symbol, {options.host.timeout_s * counting_is_slower_by, interrupted});
  if (counts.empty() && !interrupted()) {
    fmt::print(stderr, "attest: no instructions were counted: valgrind is missing, or failed\n");
  }
  return counts;
}

Result<void> check(const TimeCommandOptions& options, const std::string& suite) {
  if (options.instructions && kind_of(options.host.port).is_program) {
    return fail(
        "--instructions counts those of a library: a program has a process of its own; run "
        "valgrind on the program itself");
  }
  return check_outputs(
      {options.html, options.json, options.measure.worst, options.write_budget_file},
      {options.host.port, {options.budget_file}}, suite);
}

// How the port counts, with the clock of the user. Errors: an option needs a port that counts in
// another way.
Result<std::optional<CostCounter>> counter_for(const TimeCommandOptions& options,
                                               const Declarations& port) {
  std::optional<CostCounter> counter = port.cost;
  const std::string is = counter ? fmt::format("this port counts {}", name_of(counter->unit))
                                 : "this port does not count the cost of its steps";
  if (options.clock_hz) {
    if (!counter || counter->unit != CostUnit::cycles) {
      return fail("--clock-hz needs a port that counts cycles; " + is);
    }
    counter->clock_hz = *options.clock_hz;
  }
  if (options.measure.budget_us && !cost_ns(counter)) {
    return fail("--budget is a time, and " + is + "; use --budget-file");
  }
  if (counter) return counter;
  for (const auto& [name, file] : {std::pair("--budget-file", &options.budget_file),
                                   std::pair("--write-budget-file", &options.write_budget_file)}) {
    if (!file->empty()) {
      return fail(
          fmt::format("{} needs a port that counts the cost of its steps (PROTOCOL.md): the "
                      "times of the host's clock differ from run to run",
                      name));
    }
  }
  return counter;
}

struct TimedPort {
  HostOptions host;  // Ctrl-C stops the port
  PortDescription port;
  std::optional<CostCounter> counter;
  std::optional<CostBudget> budget;  // of --budget-file
};

Result<TimedPort> open_timed(const TimeCommandOptions& options) {
  TimedPort timed{options.host, {}, {}, {}};
  timed.host.stop = interrupted;
  auto port = prepare_port(timed.host);
  if (!port) return tl::unexpected(port.error());
  timed.port = *std::move(port);
  const auto counter = counter_for(options, timed.port);
  if (!counter) return tl::unexpected(counter.error());
  timed.counter = *counter;
  if (options.budget_file.empty()) return timed;
  auto budget = read_cost_budget(options.budget_file);
  if (!budget) return tl::unexpected(budget.error());
  timed.budget = *std::move(budget);
  return timed;
}

Result<CorpusTimes> timed(const TimeOptions& measure, const HostOptions& host,
                          const std::vector<SelectedCase>& cases, bool quiet) {
  std::size_t vectors = 0;
  for (const SelectedCase& selected : cases) vectors += selected.configurations.size();
  Progress progress(vectors, Progress::on_stderr(quiet));
  auto times =
      time_corpus(cases, measure, host, [&](const VectorResult& result) { progress.add(result); });
  progress.finish();
  return times;
}

// Compares the costs with the budget file, or writes them to one. A file is written only if every
// vector that was selected has costs. Errors: those of the file.
Result<void> use_budget_file(const TimeCommandOptions& options, const TimedPort& port,
                             std::optional<AtomicFile> file, TimeRun& run) {
  if (!file && !port.budget) return {};
  const CostBudget now = cost_budget_of(run.times, port.port.name, *port.port.cost);
  if (port.budget) {
    if (auto same = check_same_port(*port.budget, now, options.budget_file); !same) return same;
    run.budget_file = options.budget_file;
    run.changes = changes(*port.budget, now, options.growth_percent);
    return {};
  }
  const bool any_fails = std::ranges::any_of(run.times.vectors, [](const VectorTimes& vector) {
    return fails_a_run(vector.result.verdict);
  });
  if (any_fails) {
    fmt::print(stderr, "attest: {} is not written: a vector has no costs\n",
               options.write_budget_file);
    return {};
  }
  return file->commit(text_of(now));
}

int report(const TimeCommandOptions& options, const TimeRun& run, const Document& document,
           bool quiet) {
  const bool failed = fails_a_run(document.head.verdict);
  if (quiet && !failed) return exit_ok;
  fmt::print("{}{}", render_text(document, terminal_style(stdout)),
             run.counter ? "" : exchange_note(run.port));
  const std::string worst = options.measure.worst.string();
  if (!worst.empty()) {
    fmt::print("the slowest step again: attest replay {} --profile {}\n", worst,
               run.times.with_slowest_step()->result.profile);
  }
  return failed ? exit_failed : exit_ok;
}

// No vector was timed.
int report_untimed(const TimeRun& run, const TimeCommandOptions& options,
                   const std::vector<SelectedCase>& cases) {
  const Document document = time_document(run);
  if (!fails_a_run(document.head.verdict)) {
    return report_error(
        supported_instead(options.host, profiles_in(cases),
                          [](const std::string& profile, const std::string& port) {
                            return "attest time --profile " + profile + port;
                          })
            .value_or(
                Error{"no vector was timed: every selected vector was skipped or unsupported"}));
  }
  fmt::print("{}", render_text(document, terminal_style(stdout)));
  return exit_failed;
}

int time_command(const TimeCommandOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  if (const auto checked = check(options, globals.suite); !checked) {
    return report_error(checked.error());
  }
  const auto cases = open_loop_cases(options, *suite);
  if (!cases) return report_error(cases.error());
  auto json = AtomicFile::open(options.json);
  if (!json) return report_error(json.error());
  auto html = AtomicFile::open(options.html);
  if (!html) return report_error(html.error());
  auto worst = AtomicFile::open(options.measure.worst);
  if (!worst) return report_error(worst.error());
  std::optional<AtomicFile> budget_file;
  if (!options.write_budget_file.empty()) {
    auto file = AtomicFile::open(options.write_budget_file);
    if (!file) return report_error(file.error());
    budget_file.emplace(*std::move(file));
  }
  StdoutDiversion diversion(options.host.in_process);
  const auto port = open_timed(options);
  if (!port) return report_error(port.error());
  const HostOptions& host = port->host;
  TimeOptions measure = options.measure;
  measure.counter = port->counter;
  if (kind_of(host.port).is_program) measure.stack = false;  // it is in another process

  note_interrupts();
  auto times = timed(measure, host, *cases, globals.quiet);
  if (interrupted()) return exit_interrupted;
  if (!times) return report_error(times.error());
  TimeRun run{options.host.port,
              measure.runs(),
              measure.budget_us,
              *std::move(times),
              {},
              static_cast<std::uint64_t>(options.allowed),
              port->port.name,
              measure.counter};
  const VectorTimes* const slowest = run.times.with_slowest_step();
  if (!slowest) {
    diversion.end();
    return report_untimed(run, options, *cases);
  }
  if (!options.measure.worst.empty()) {
    const auto written = write_slowest(run.times, *cases, host, *std::move(worst));
    if (!written) return report_error(written.error());
  }
  if (auto used = use_budget_file(options, *port, std::move(budget_file), run); !used) {
    return report_error(used.error());
  }
  if (options.instructions) {
    run.instructions = counted(options, *suite, slowest->result.id());
    if (interrupted()) return exit_interrupted;
  }
  if (auto same = check_port(host); !same) return report_error(same.error());
  diversion.end();
  const Document document = time_document(run);
  for (const auto& written :
       {json->commit(time_json(run)),
        options.html.empty() ? Result<void>() : html->commit(html_page(document))}) {
    if (!written) return report_error(written.error());
  }
  return report(options, run, document, globals.quiet);
}

void add_budget_file(Command command, TimeCommandOptions& options) {
  const Option file =
      command
          .option("--budget-file", options.budget_file,
                  "Fail if the worst cost of a group at a rate grew over this file; for a port "
                  "that counts the cost of its steps")
          .type("F");
  command
      .option("--allow-growth", options.growth_percent,
              "Growth over --budget-file that does not fail [%]")
      .range(0.0, 1000.0)
      .needs(file)
      .shows_default();
  command
      .option("--write-budget-file", options.write_budget_file,
              "Write the worst costs for --budget-file")
      .type("F")
      .excludes(file);
}

}  // namespace

void add_time(const CommandLine& line) {
  auto options = std::make_shared<TimeCommandOptions>();
  const Command command =
      line.add("time",
               "Measure the execution time and the stack use of a port's steps in the "
               "open-loop vectors");
  add_port(command, options->host);
  add_port_argument(command, options->host);
  add_selection(command, options->select, Selects::open_loop);
  command
      .option("--repeat", options->measure.repeats,
              "Number of runs of each vector; the shortest time of each step counts, or the "
              "largest of a port's own counts")
      .range(1, 1000)
      .shows_default("5; 1 for a port's own counts");
  const Option budget = command
                            .option("--budget", options->measure.budget_us,
                                    "Fail if a step takes longer than this [us]; default: no limit")
                            .positive();
  command.option("--allow", options->allowed, "Number of steps that may exceed --budget")
      .at_least_zero()
      .needs(budget)
      .shows_default();
  command
      .option("--clock-hz", options->clock_hz,
              "Clock of a port that counts cycles [Hz], such as 168e6; default: the one that it "
              "declares")
      .range(1.0, 1e12);
  add_budget_file(command, *options);
  command
      .option("--worst", options->measure.worst,
              "Write the trace of the vector with the slowest step, up to that step, for "
              "`attest replay`")
      .type("F.csv");
  command.flag("--instructions", options->instructions,
               "Count the instructions of the steps of the slowest vector with valgrind; "
               "default: off");
  command.flag("--stack,!--no-stack", options->measure.stack,
               "Measure the largest stack use of a step, in one more run of each vector; "
               "default: on");
  add_page(command, options->html,
           "a page with the times by group and rate, and with the slowest vectors");
  command
      .option("--json", options->json, "Write the times and the stack use of each vector as JSON")
      .type("F")
      .group(option_group::reports);
  add_timeout(command, options->host.timeout_s);
  command
      .flag("--in-process", options->host.in_process,
            "Run the port in attest's own process, for valgrind, perf or a debugger")
      .group(option_group::execution);
  command.examples({{"attest time --port lib:./libmine.so --worst slowest.csv",
                     "write the trace with the slowest step"},
                    {"attest time --port lib:./libmine.so --budget 20 --rate 250",
                     "fail if a step takes more than 20 us"},
                    {"attest time --port proc:./board --clock-hz 168e6 --budget-file costs.json",
                     "compare the costs that the port counts with those of a file"},
                    {"attest time --port lib:./libmine.so --profile px4-v1.16.0",
                     "measure the attitude unit and the rate unit, with a row for each"}});
  command.runs(options, time_command);
}

}  // namespace attest::cli
