#include "harness/measure/stress.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/casefile/parse_limits.hpp"
#include "harness/cli/exchange_note.hpp"
#include "harness/cli/find_case.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/process/program.hpp"
#include "harness/realtime/load.hpp"
#include "harness/report/report.hpp"
#include "harness/report/stress_document.hpp"

namespace attest::cli {
namespace {

struct StressOptions {
  HostOptions host;
  std::vector<std::string> rates = {"250", "500", "1000", "2000", "4000", "8000"};
  double duration_s = 10;
  CaseChoice flight{"flight/hover", ""};
  std::string vehicle, plant;  // empty: the lead vehicle and the first plant of the case
  int load = 0;
  std::string load_kind = "cpu";
  std::string policy = "fifo";
  int cpus = 2;
  double spin_us = 0;
  // Empty: the budget of the case.
  std::optional<double> misses_per_million, p99_latency_us, execution_us;
  std::string html, json, junit, record_timing;
  bool cyclictest = true;
};

// The idle machine is measured for as long as the flight takes, but at most for this time.
constexpr double idle_s_max = 5;

// An hour at 8 kHz is 28.8 million. Each takes about 100 bytes of the 4 GiB that the port's process
// may have.
constexpr std::int64_t most_deadlines = 30'000'000;

Nanoseconds nanoseconds(double seconds) {
  return Nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

// With two CPUs the unit runs on the second one, because the first one serves most interrupts.
Result<LiveOptions> live_options(const StressOptions& options) {
  LiveOptions live;
  const std::vector<int> cpus = usable_cpus();
  live.plant_cpu = cpus.front();
  live.unit_cpu = options.cpus == 1 || cpus.size() == 1 ? cpus.front() : cpus[1];
  live.wait.spin = nanoseconds(options.spin_us * 1e-6);
  if (options.policy != "fifo" && options.policy != "other") {
    return fail(fmt::format("no such policy: `{}`; there are fifo and other", options.policy));
  }
  live.fifo = options.policy == "fifo";
  return live;
}

struct StressPlan {
  std::vector<StressTask> tasks;
  LoadKind load = LoadKind::cpu;
  HostOptions host;
  PortDescription port;
};

void set_budget(const StressOptions& options, RealtimeBudget& budget) {
  if (options.misses_per_million) budget.misses_per_million = *options.misses_per_million;
  if (options.p99_latency_us) budget.p99_latency_us = *options.p99_latency_us;
  if (options.execution_us) budget.execution_us = *options.execution_us;
}

Result<StressPlan> make_plan(const StressOptions& options, const SuiteFolder& suite) {
  const auto rates = parse_rates(options.rates);
  if (!rates) return tl::unexpected(rates.error());
  const auto live = live_options(options);
  if (!live) return tl::unexpected(live.error());
  const auto load = parse_load_kind(options.load_kind);
  if (!load) return tl::unexpected(load.error());
  if (!options.record_timing.empty() && options.rates.size() != 1) {
    return fail("--record-timing records one rate; name it with --rates");
  }
  std::shared_ptr<AtomicFile> timing;
  if (!options.record_timing.empty()) {
    auto file = AtomicFile::open(options.record_timing);
    if (!file) return tl::unexpected(file.error());
    timing = std::make_shared<AtomicFile>(*std::move(file));
  }
  StressPlan plan;
  plan.host = options.host;
  auto prepared = prepare_for_flight(options.flight, rates->front(), suite, plan.host);
  if (!prepared) return tl::unexpected(prepared.error());
  auto chosen =
      choose_flight(prepared->choice, rates->front(), options.vehicle, options.plant, suite);
  if (!chosen) return tl::unexpected(chosen.error());

  Case& the_case = chosen->the_case;
  the_case.duration = {options.duration_s, Span::In::seconds};
  set_budget(options, the_case.flight->realtime);
  plan.load = *load;
  plan.port = std::move(prepared->port);
  for (const LoopRate& given : *rates) {
    const LoopRate rate = rate_of_flight(the_case, given);
    if (auto sane = check_rate(the_case, rate); !sane) return tl::unexpected(sane.error());
    if (auto few = check_ticks(the_case, rate, most_deadlines); !few) {
      return tl::unexpected(few.error());
    }
    plan.tasks.push_back({the_case, RunConfiguration{rate, chosen->plant_configuration},
                          chosen->vehicle_model, plan.port, *live,
                          nanoseconds(std::min(options.duration_s, idle_s_max)), timing});
  }
  return plan;
}

// Prints each StressProgress on stderr, in flight about one a second. On a terminal each line
// replaces the previous one.
class StressProgressLine {
 public:
  StressProgressLine(bool visible, TerminalStyle style) : visible_(visible), style_(style) {}
  ~StressProgressLine() { erase(); }

  void show(const StressTask& task, const StressProgress& now) {
    if (!visible_) return;
    const std::string what =
        now.idle
            ? "idle machine"
            : fmt::format("{:.0f} of {:g} s, {} deadlines, {} missed", in_seconds(now.live.time),
                          task.the_case.duration.amount, now.live.deadlines, now.live.missed);
    const bool terminal = style_.width > 0;
    fmt::print(stderr, "{}{} Hz: {}{}", terminal ? "\r\x1b[K" : "",
               task.configuration.rate.to_string(), what, terminal ? "" : "\n");
    std::fflush(stderr);
    drawn_ = terminal;
  }

  void erase() {
    if (drawn_) fmt::print(stderr, "\r\x1b[K");
    drawn_ = false;
  }

 private:
  bool visible_, drawn_ = false;
  TerminalStyle style_;
};

// Empty: cyclictest gave no result. If it is installed, a note explains the missing row of the
// report.
std::optional<Cyclictest> idle_by_cyclictest(const StressTask& task) {
  auto idle = run_cyclictest(task.configuration.rate.motor_unit, task.idle_duration, task.live,
                             interrupted);
  if (!idle && !interrupted() && is_installed("cyclictest")) {
    fmt::print(stderr, "attest: cyclictest failed, or gave no figures in time\n");
  }
  return idle;
}

// Measures at each rate in turn: cyclictest, the idle machine, the flight.
Result<void> run_all(const StressPlan& plan, const StressOptions& options, const Globals& globals,
                     StressRun& run) {
  const TerminalStyle style = terminal_style(stdout);
  StressProgressLine line(!globals.quiet, terminal_style(stderr));
  const Load load(plan.load, options.load);
  run.load = load.description();
  for (const StressTask& task : plan.tasks) {
    if (interrupted()) break;
    const auto progress = [&](const StressProgress& now) { line.show(task, now); };
    const auto judge = options.cyclictest ? idle_by_cyclictest(task) : std::nullopt;
    auto results = run_stress(task, plan.host, interrupted, progress);
    if (!results) return tl::unexpected(results.error());
    line.erase();
    if (run.results.empty() && !globals.quiet) {
      for (const auto& [name, value] : privileges_of(results->front())) {
        if (!value.empty()) fmt::print("{}: {}\n", name, value);
      }
      fmt::print("{}", exchange_note(run.port));
    }
    for (StressResult& stress : *results) {
      stress.cyclictest = judge;
      const bool shown = !globals.quiet || stress.result.verdict != Verdict::pass;
      if (shown) fmt::print("{}", render_text(result_table(stress), style));
      run.results.push_back(std::move(stress));
    }
    std::fflush(stdout);
  }
  for (const std::string& note : {note_on_units(run), note_on_cost(run)}) {
    if (!note.empty() && !globals.quiet) fmt::print("note: {}\n", note);
  }
  run.interrupted = interrupted();
  return {};
}

int stress_command(const StressOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  const auto checked =
      check_outputs({options.html, options.json, options.junit, options.record_timing},
                    {options.host.port, {options.flight.name}}, globals.suite);
  if (!checked) return report_error(checked.error());
  auto json = AtomicFile::open(options.json);
  if (!json) return report_error(json.error());
  auto junit = AtomicFile::open(options.junit);
  if (!junit) return report_error(junit.error());
  auto html = AtomicFile::open(options.html);
  if (!html) return report_error(html.error());
  const auto plan = make_plan(options, *suite);
  if (!plan) return report_error(plan.error());
  if (plan->port.profiles.empty()) {
    const auto instead = supported_instead(
        options.host, {plan->tasks.front().the_case.profile},
        hover_command("attest stress --case", globals, options.flight.name, options.host.port));
    if (instead) return report_error(*instead);
  }

  note_interrupts();
  StressRun run;
  run.suite_folder = globals.suite;
  run.case_file = path_from_here(plan->tasks.front().the_case.file);
  run.port = options.host.port;
  run.description = plan->port;
  run.live = plan->tasks.front().live;
  run.budget = plan->tasks.front().the_case.flight->realtime;
  if (auto done = run_all(*plan, options, globals, run); !done) return report_error(done.error());
  if (auto same = check_port(plan->host); !same) return report_error(same.error());
  const RunResult all = run_of(run);
  const auto has_flown = [](const StressResult& stress) { return stress.deadlines > 0; };
  const Document document = stress_document(run);
  // Without a flight, a page of an earlier run is kept.
  const bool has_page = std::ranges::any_of(run.results, has_flown);
  for (const auto& written : {json->commit(stress_json(run)), junit->commit(junit_report(all)),
                              has_page ? html->commit(html_page(document)) : Result<void>()}) {
    if (!written) return report_error(written.error());
  }
  if (!globals.quiet) fmt::print("{}", render_text(document.head, terminal_style(stdout)));
  if (run.interrupted) return exit_interrupted;
  if (all.failed()) return exit_failed;
  if (const auto missing = rates_not_judged(run); !missing.empty()) {
    return report_error(
        {fmt::format("not judged: {} Hz; see the reasons above", fmt::join(missing, " Hz, "))});
  }
  return exit_ok;
}

// The conditions of the flight: load, scheduling, CPUs.
void add_machine(Command command, StressOptions& options) {
  command.option("--load", options.load, "Number of processes that load the machine")
      .range(0, 1024)
      .type("N")
      .shows_default()
      .group(option_group::execution);
  command
      .option("--load-kind", options.load_kind,
              "Resource that the processes of --load use: `cpu`, `cache` or `io`")
      .type("KIND")
      .shows_default()
      .group(option_group::execution);
  command
      .option("--policy", options.policy,
              "Scheduling policy of port and plant: `fifo` (where it is permitted) or `other`")
      .type("POLICY")
      .shows_default()
      .group(option_group::execution);
  command
      .option("--cpus", options.cpus,
              "Number of CPUs: with 2, port and plant have a CPU each; with 1, they share it")
      .range(1, 2)
      .shows_default()
      .group(option_group::execution);
  command
      .option("--spin", options.spin_us,
              "Wake the port this time [us] before each release, and let it spin until the "
              "release")
      .range(0.0, 1e6)
      .shows_default()
      .group(option_group::execution);
  command
      .flag("--cyclictest,!--no-cyclictest", options.cyclictest,
            "Measure the idle machine with cyclictest too, where it is installed; default: "
            "on")
      .group(option_group::execution);
}

void add_budgets(Command command, StressOptions& options) {
  const auto add = [&](const char* name, std::optional<double>& limit, const char* what) {
    command.option(name, limit, what).at_least_zero().group(option_group::strictness);
  };
  add("--misses-per-million", options.misses_per_million,
      "Limit of deadline misses, and also of overruns, per million deadlines; default: that of the "
      "case");
  add("--p99-latency", options.p99_latency_us,
      "Wake-up latency that 1% of the steps may exceed [us]; default: that of the case");
  add("--budget", options.execution_us,
      "Execution time above which a step is an overrun [us]; default: that of the case");
}

void add_stress_reports(Command command, StressOptions& options) {
  command
      .option("--record-timing", options.record_timing,
              "Write the times of all ticks, for `run --timing` and `sim --timing`; needs a "
              "single rate")
      .type("F")
      .group(option_group::reports);
  add_page(command, options.html, "a page with the distributions of the times and a timeline");
  add_json_and_junit(command, options.json, "Write all measurements as JSON", options.junit);
}

}  // namespace

void add_stress(const CommandLine& line) {
  auto options = std::make_shared<StressOptions>();
  const Command command =
      line.add("stress",
               "Fly one case in real time with a port, and measure latency, execution time, "
               "response time and deadline misses");
  add_port(command, options->host);
  add_port_argument(command, options->host);
  add_rates(command, options->rates,
            "Loop rates [Hz], separated by commas; for v1.14 to v1.18 pairs such as 250:1000, or "
            "rates of the rate unit, with the attitude unit at 250")
      .shows_default("250,500,1000,2000,4000,8000");
  command.option("--duration", options->duration_s, "Duration of the flight at each rate [s]")
      .range(0.1, 3600.0)
      .shows_default();
  add_case(command, options->flight);
  add_plant(command, options->vehicle, options->plant);
  add_machine(command, *options);
  add_budgets(command, *options);
  add_stress_reports(command, *options);
  add_timeout(command, options->host.timeout_s);
  command.examples({{"attest stress --port lib:./libmine.so", "fly at 250 Hz to 8 kHz, 10 s each"},
                    {"attest stress --port lib:./libmine.so --rate 1000 --load 2 --load-kind cache",
                     "fly while two processes fill the caches"},
                    {"attest stress --case hover --rate 250:1000",
                     "fly the attitude unit at 250 Hz and the rate unit at 1 kHz"},
                    {"attest stress --rate 500 --duration 5 --record-timing t.json",
                     "record the times; `attest run --timing t.json` replays them"}});
  command.runs(options, stress_command);
}

}  // namespace attest::cli
