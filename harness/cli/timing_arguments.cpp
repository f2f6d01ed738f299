#include "harness/cli/timing_arguments.hpp"

#include <algorithm>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>

namespace attest::cli {

void add_port(CLI::App& command, std::string& port) {
  command.add_option("--port", port, "`builtin` (the reference), `lib:PATH` or `fault:ID`")
      ->type_name("PORT")
      ->capture_default_str();
}

void add_timeout(CLI::App& command, double& timeout_s) {
  command
      .add_option(
          "--timeout", timeout_s,
          "Limit for each answer of the port [s]; a port that gives no answer in time has the "
          "verdict `timeout`")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
}

void add_selection(CLI::App& command, SelectionOptions& options) {
  command
      .add_option("--filter", options.filters,
                  "Only cases whose id matches this shell pattern; quote it. Ids are "
                  "PROFILE/GROUP/NAME@CONFIGURATION; profile and configuration may be left out")
      ->type_name("GLOB")
      ->allow_extra_args(false);
  command.add_option("--group", options.groups, "Only this group of cases")
      ->type_name("GROUP")
      ->allow_extra_args(false);
  command.add_option("--profile", options.profiles, "Only this version of the law")
      ->type_name("PROFILE")
      ->allow_extra_args(false);
  command.add_option("--rate", options.rates, "Only these loop rates [Hz], separated by commas")
      ->type_name("HZ,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--vehicle", options.vehicles, "Only flights of this vehicle")
      ->type_name("VEHICLE")
      ->allow_extra_args(false);
  command.add_option("--plant", options.plants, "Only flights on this plant: `mujoco` or `ode`")
      ->type_name("PLANT")
      ->allow_extra_args(false);
}

namespace {

void add_stress(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<StressOptions>();
  CLI::App* command = app.add_subcommand("stress",
                                         "Let a port fly in real time, at each loop rate: latency, "
                                         "execution time, response time, misses");
  add_port(*command, options->host.port);
  command->add_option("--rates", options->rates, "Loop rates [Hz], separated by commas")
      ->type_name("HZ,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str("250,500,1000,2000,4000,8000");
  command->add_option("--duration", options->duration_s, "Of the flight at each rate [s]")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_option("--case", options->case_name, "A flight: its name or id, or a case file")
      ->type_name("CASE")
      ->capture_default_str();
  command->add_option("--vehicle", options->vehicle, "One of `attest list --vehicles`")
      ->type_name("VEHICLE");
  command->add_option("--plant", options->plant, "`mujoco` or `ode`")->type_name("PLANT");
  command->add_option("--load", options->load, "So many workers that keep the machine busy")
      ->check(CLI::Range(0, 1024))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--load-kind", options->load_kind, "What they do: `cpu`, `cache` or `io`")
      ->type_name("KIND")
      ->capture_default_str();
  command
      ->add_option("--policy", options->policy,
                   "Of the two threads: `fifo` (where it is permitted) or `other`")
      ->capture_default_str();
  command->add_option("--cpus", options->cpus, "2: unit and plant on one each; 1: both on one")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  command
      ->add_option("--spin", options->spin_us, "Wake up so long before the release and spin [us]")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command
      ->add_option(
          "--misses-per-million", options->misses_per_million,
          "Deadlines that may be missed, and steps that may overrun, instead of the case's")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--p99-latency", options->p99_latency_us,
                   "Wake-up latency that 1% of the steps may exceed [us], instead of the case's")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--budget", options->execution_us,
                   "Execution time [us]; a longer step is an overrun, and counts like a miss")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--record-timing", options->record_timing,
                   "Write when everything happened, for `run --timing`; one rate only")
      ->type_name("F");
  command->add_option("--json", options->json, "Write all that was measured")->type_name("F");
  command->add_option("--junit", options->junit, "Write a report for CI servers")->type_name("F");
  command->add_flag("--cyclictest,!--no-cyclictest", options->cyclictest,
                    "Let cyclictest measure the idle machine too, where it is installed");
  add_timeout(*command, options->host.timeout_s);
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return stress_command(*options, globals); };
  });
}

void add_sweep_rate(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<SweepOptions>();
  options->jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  CLI::App* command = app.add_subcommand(
      "sweep-rate",
      "Where each vehicle stops holding: lowest loop rate, largest delay of the motor commands");
  command->add_option("--case", options->case_name, "A flight, whose metrics say what holding is")
      ->type_name("CASE")
      ->capture_default_str();
  command->add_option("--rates", options->rates, "Rates to find the largest delay at [Hz]")
      ->type_name("HZ,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str("50,100,250,500,1000");
  command->add_option("--vehicle", options->vehicles, "Only this vehicle")
      ->type_name("VEHICLE")
      ->allow_extra_args(false);
  command->add_option("--plant", options->plants, "Only on this plant: `mujoco` or `ode`")
      ->type_name("PLANT")
      ->allow_extra_args(false);
  add_port(*command, options->host.port);
  command->add_option("--csv", options->csv, "Write the table")->type_name("F.csv");
  add_timeout(*command, options->host.timeout_s);
  command->add_option("--jobs,-j", options->jobs, "Vehicles at a time")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return sweep_rate_command(*options, globals); };
  });
}

void add_schedule(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<ScheduleOptions>();
  CLI::App* command = app.add_subcommand("schedule",
                                         "What a loop feels of the tasks beside it: fixed "
                                         "priorities on one or two CPUs, and a flight");
  command->add_option("tasks", options->tasks, "The tasks (TOML): [task.unit] and those beside it")
      ->type_name("TASKS.toml")
      ->required();
  command->add_option("--case", options->case_name, "A flight: its name or id, or a case file")
      ->type_name("CASE")
      ->capture_default_str();
  command->add_option("--vehicle", options->vehicle, "One of `attest list --vehicles`")
      ->type_name("VEHICLE");
  command->add_option("--plant", options->plant, "`mujoco` or `ode`")->type_name("PLANT");
  add_port(*command, options->host.port);
  command
      ->add_option("--record-timing", options->record_timing,
                   "Write when everything happens, for `run --timing` and `sim --timing`")
      ->type_name("F");
  add_timeout(*command, options->host.timeout_s);
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return schedule_command(*options, globals); };
  });
}

void add_time(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<TimeCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "time",
      "How long a port's steps take over the corpus, which input takes longest, and how "
      "much stack they use");
  add_port(*command, options->host.port);
  add_selection(*command, options->select);
  command
      ->add_option("--repeat", options->measure.repeats,
                   "Runs of each vector; of each step the quickest counts, which is the port's and "
                   "not the machine's")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI::Option* const budget = command
                                  ->add_option("--budget", options->measure.budget_us,
                                               "Fail when steps take longer than this [us]")
                                  ->check(CLI::PositiveNumber);
  command->add_option("--allow", options->allowed, "So many steps may be over the budget")
      ->check(CLI::NonNegativeNumber)
      ->needs(budget)
      ->capture_default_str();
  command
      ->add_option("--worst", options->measure.worst,
                   "Write the vector up to its slowest step, for `attest replay`")
      ->type_name("F.csv");
  command->add_flag("--instructions", options->instructions,
                    "Count the instructions of the slowest vector's steps, with valgrind");
  command->add_flag(
      "--stack,!--no-stack", options->measure.stack,
      "Measure the most stack that a step uses, in one more run of each vector (on by "
      "default)");
  command->add_option("--json", options->json, "Write all times and stack use, by vector")
      ->type_name("F");
  add_timeout(*command, options->host.timeout_s);
  command->add_flag("--in-process", options->host.in_process,
                    "Run the port in attest's own process: for valgrind, perf or a debugger");
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return time_command(*options, globals); };
  });
}

}  // namespace

void add_timing_commands(CLI::App& app, const Globals& globals, Action& action) {
  add_stress(app, globals, action);
  add_sweep_rate(app, globals, action);
  add_schedule(app, globals, action);
  add_time(app, globals, action);
}

}  // namespace attest::cli
