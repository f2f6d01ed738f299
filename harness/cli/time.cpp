#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "harness/cli/exchange_note.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
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
  return check_outputs({options.html, options.json, options.measure.worst}, {options.host.port, {}},
                       suite);
}

// The host options of the command; Ctrl-C then stops the port.
Result<HostOptions> host_for(const TimeCommandOptions& options) {
  HostOptions host = options.host;
  host.stop = interrupted;
  if (auto port = prepare_port(host); !port) return tl::unexpected(port.error());
  return host;
}

Result<CorpusTimes> timed(const TimeCommandOptions& options, const HostOptions& host,
                          const std::vector<SelectedCase>& cases, bool quiet) {
  std::size_t vectors = 0;
  for (const SelectedCase& selected : cases) vectors += selected.configurations.size();
  Progress progress(vectors, Progress::on_stderr(quiet));
  TimeOptions measure = options.measure;
  measure.stack =
      measure.stack && !kind_of(host.port).is_program;  // its stack is in another process
  auto times =
      time_corpus(cases, measure, host, [&](const VectorResult& result) { progress.add(result); });
  progress.finish();
  return times;
}

int report(const TimeCommandOptions& options, const TimeRun& run, const Document& document,
           bool quiet) {
  const bool failed = fails_a_run(document.head.verdict);
  if (quiet && !failed) return exit_ok;
  fmt::print("{}{}", render_text(document, terminal_style(stdout)), exchange_note(run.port));
  const std::string worst = options.measure.worst.string();
  if (!worst.empty()) {
    fmt::print("the slowest step again: attest replay {} --profile {}\n", worst,
               run.times.with_slowest_step()->result.profile);
  }
  return failed ? exit_failed : exit_ok;
}

// No vector was timed.
int report_untimed(const TimeRun& run) {
  const Document document = time_document(run);
  if (!fails_a_run(document.head.verdict)) {
    return report_error({"no vector was timed: every selected vector was skipped or unsupported"});
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
  const auto host = host_for(options);
  if (!host) return report_error(host.error());

  note_interrupts();
  auto times = timed(options, *host, *cases, globals.quiet);
  if (interrupted()) return exit_interrupted;
  if (!times) return report_error(times.error());
  TimeRun run{options.host.port,
              options.measure.repeats,
              options.measure.budget_us,
              *std::move(times),
              {},
              static_cast<std::uint64_t>(options.allowed)};
  const VectorTimes* const slowest = run.times.with_slowest_step();
  if (!slowest) return report_untimed(run);
  if (!options.measure.worst.empty()) {
    const auto written = write_slowest(run.times, *cases, *host, *std::move(worst));
    if (!written) return report_error(written.error());
  }
  if (options.instructions) {
    run.instructions = counted(options, *suite, slowest->result.id());
    if (interrupted()) return exit_interrupted;
  }
  if (auto same = check_port(*host); !same) return report_error(same.error());
  const Document document = time_document(run);
  for (const auto& written :
       {json->commit(time_json(run)),
        options.html.empty() ? Result<void>() : html->commit(html_page(document))}) {
    if (!written) return report_error(written.error());
  }
  return report(options, run, document, globals.quiet);
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
              "Number of runs of each vector; the shortest time of each step counts")
      .range(1, 1000)
      .shows_default();
  const Option budget = command
                            .option("--budget", options->measure.budget_us,
                                    "Fail if a step takes longer than this [us]; default: no limit")
                            .positive();
  command.option("--allow", options->allowed, "Number of steps that may exceed --budget")
      .at_least_zero()
      .needs(budget)
      .shows_default();
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
                    {"attest time --port lib:./libmine.so --profile px4-v1.16.0",
                     "measure the attitude unit and the rate unit, with a row for each"}});
  command.runs(options, time_command);
}

}  // namespace attest::cli
