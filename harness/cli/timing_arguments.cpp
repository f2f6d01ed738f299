#include "harness/cli/timing_arguments.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace attest::cli {

namespace {

// The conditions of the flight: load, scheduling, CPUs.
void add_machine(CLI::App& command, StressOptions& options) {
  command.add_option("--load", options.load, "Number of processes that load the machine")
      ->check(CLI::Range(0, 1024))
      ->type_name("N")
      ->capture_default_str()
      ->group(option_group::execution);
  command
      .add_option("--load-kind", options.load_kind,
                  "Resource that the processes of --load use: `cpu`, `cache` or `io`")
      ->type_name("KIND")
      ->capture_default_str()
      ->group(option_group::execution);
  command
      .add_option("--policy", options.policy,
                  "Scheduling policy of port and plant: `fifo` (where it is permitted) or `other`")
      ->type_name("POLICY")
      ->capture_default_str()
      ->group(option_group::execution);
  command
      .add_option("--cpus", options.cpus,
                  "Number of CPUs: with 2, port and plant have a CPU each; with 1, they share it")
      ->check(CLI::Range(1, 2))
      ->capture_default_str()
      ->group(option_group::execution);
  command
      .add_option("--spin", options.spin_us,
                  "Wake the port this time [us] before each release, and let it spin until the "
                  "release")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str()
      ->group(option_group::execution);
  command
      .add_flag("--cyclictest,!--no-cyclictest", options.cyclictest,
                "Measure the idle machine with cyclictest too, where it is installed; default: "
                "on")
      ->group(option_group::execution);
}

void add_budgets(CLI::App& command, StressOptions& options) {
  command
      .add_option("--misses-per-million", options.misses_per_million,
                  "Limit of deadline misses, and also of overruns, per million deadlines; default: "
                  "that of the case")
      ->check(CLI::NonNegativeNumber)
      ->group(option_group::strictness);
  command
      .add_option("--p99-latency", options.p99_latency_us,
                  "Wake-up latency that 1% of the steps may exceed [us]; default: that of the "
                  "case")
      ->check(CLI::NonNegativeNumber)
      ->group(option_group::strictness);
  command
      .add_option("--budget", options.execution_us,
                  "Execution time above which a step is an overrun [us]; default: that of the "
                  "case")
      ->check(CLI::NonNegativeNumber)
      ->group(option_group::strictness);
}

void add_stress_reports(CLI::App& command, StressOptions& options) {
  command
      .add_option("--record-timing", options.record_timing,
                  "Write the times of all ticks, for `run --timing` and `sim --timing`; needs a "
                  "single rate")
      ->type_name("F")
      ->group(option_group::reports);
  add_page(command, options.html, "a page with the distributions of the times and a timeline");
  command.add_option("--json", options.json, "Write all measurements as JSON")
      ->type_name("F")
      ->group(option_group::reports);
  command.add_option("--junit", options.junit, "Write a JUnit XML report")
      ->type_name("F")
      ->group(option_group::reports);
}

void add_stress(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<StressOptions>();
  CLI::App* command = app.add_subcommand(
      "stress",
      "Fly one case in real time with a port, and measure latency, execution time, "
      "response time and deadline misses");
  add_port(*command, globals, options->host);
  add_rates(*command, options->rates,
            "Loop rates [Hz], separated by commas; for v1.14 to v1.16 pairs such as 250:1000")
      ->default_str("250,500,1000,2000,4000,8000");
  command->add_option("--duration", options->duration_s, "Duration of the flight at each rate [s]")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--case", options->case_name,
                   "The flight: the name or id of a case, or a case file")
      ->type_name("CASE")
      ->capture_default_str();
  add_plant(*command, options->vehicle, options->plant);
  add_machine(*command, *options);
  add_budgets(*command, *options);
  add_stress_reports(*command, *options);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command,
               {{"attest stress --port lib:./libmine.so", "fly at 250 Hz to 8 kHz, 10 s each"},
                {"attest stress --port lib:./libmine.so --rate 1000 --load 2 --load-kind cache",
                 "fly while two processes fill the caches"},
                {"attest stress --case hover --rate 250:1000",
                 "fly the attitude unit at 250 Hz and the rate unit at 1 kHz"},
                {"attest stress --rate 500 --duration 5 --record-timing t.json",
                 "record the times; `attest run --timing t.json` replays them"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return stress_command(*options, globals); };
  });
}

void add_sweep_rate(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<RateSweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep-rate",
      "Find for each vehicle the lowest loop rate and the largest delay of the motor "
      "commands at which a flight keeps its bounds");
  command
      ->add_option("--case", options->case_name,
                   "The flight, whose metrics have the bounds: the name or id of a case, or a "
                   "case file")
      ->type_name("CASE")
      ->capture_default_str();
  add_rates(*command, options->rates,
            "Loop rates at which the largest delay is searched [Hz]; for v1.14 to v1.16 "
            "pairs such as 250:1000")
      ->default_str("50,100,250,500,1000");
  command
      ->add_option("--vehicle", options->vehicles,
                   "Only this vehicle; default: all vehicles of the case")
      ->type_name("VEHICLE")
      ->allow_extra_args(false);
  command
      ->add_option("--plant", options->plants,
                   "Only this plant: `mujoco` or `ode`; default: all plants of the case")
      ->type_name("PLANT")
      ->allow_extra_args(false);
  add_port(*command, globals, options->host);
  add_page(*command, options->html, "a page with the limits, and with the metrics by rate");
  command->add_option("--csv", options->csv, "Write the table as CSV")
      ->type_name("F.csv")
      ->group(option_group::reports);
  add_timeout(*command, options->host.timeout_s);
  add_jobs(*command, options->jobs,
           "Number of pairs of vehicle and plant that fly at the same time");
  add_examples(*command, {{"attest sweep-rate --port lib:./libmine.so --vehicle iris",
                           "find the lowest rate and the largest delay for the Iris"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return sweep_rate_command(*options, globals); };
  });
}

void add_sweep_parts(CLI::App& command, SweepOptions& options) {
  command.add_option("--samples", options.samples, "Number of samples; default: that of the file")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  CLI::Option* const shard =
      command.add_option("--shard", options.shard, "Fly only part I of N of the samples")
          ->type_name("I/N")
          ->capture_default_str();
  command.add_option("--merge", options.merge, "Join the shards in these folders, and fly nothing")
      ->type_name("DIR...")
      ->excludes(shard);
  command
      .add_option("--keep-worst", options.keep_worst,
                  "Keep this number of worst flights of each requirement, for `attest sim`")
      ->check(CLI::Range(0, 1000))
      ->type_name("K")
      ->capture_default_str()
      ->group(option_group::reports);
}

void add_shard_plan(CLI::App& command, SweepOptions& options) {
  CLI::Option* const plan =
      command
          .add_option("--plan", options.plan,
                      "Fly nothing, and write to --out the files with which many machines fly the "
                      "shards: `slurm`, `parallel` (GNU parallel), `github` or `gitlab`")
          ->type_name("KIND")
          ->group(option_group::execution);
  CLI::Option* const shards =
      command.add_option("--shards", options.shards, "Number of shards of --plan")
          ->type_name("N")
          ->check(CLI::PositiveNumber)
          ->needs(plan)
          ->group(option_group::execution);
  plan->needs(shards);
  for (const char* other : {"--shard", "--merge"}) plan->excludes(command.get_option(other));
}

void add_sweep(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep",
      "Fly a case many times with dispersed values, and estimate the probability "
      "that a flight holds each requirement");
  command
      ->add_option("file", options->file,
                   "The sweep file, with case, dispersions, design and requirements")
      ->type_name("SWEEP.toml")
      ->required();
  add_plant(*command, options->vehicle, options->plant, "that of the file", "that of the file");
  add_port(*command, globals, options->host);
  command
      ->add_option("--out", options->out,
                   "Folder for the results; an interrupted sweep continues with the samples that "
                   "are missing there")
      ->type_name("DIR")
      ->required()
      ->group(option_group::reports);
  add_sweep_parts(*command, *options);
  add_page(*command, options->html,
           "a page with the requirements, distributions, sensitivities and worst flights");
  add_shard_plan(*command, *options);
  add_timeout(*command, options->host.timeout_s);
  add_jobs(*command, options->jobs,
           "Number of samples that fly at the same time, with --plan in each shard",
           "one for each CPU; with --plan, 1");
  add_examples(
      *command,
      {{"attest sweep SWEEP.toml --out results --keep-worst 3 --html sweep.html",
        "fly the reference, keep the three worst flights of each requirement, and write a page"},
       {"attest sweep SWEEP.toml --port lib:./libmine.so --out results",
        "fly port and reference on the same samples, and test whether they differ"},
       {"attest sweep SWEEP.toml --shard 2/4 --out part2", "fly the second quarter of the samples"},
       {"attest sweep SWEEP.toml --merge part1 part2 part3 part4 --out results",
        "join the four shards"},
       {"attest sweep SWEEP.toml --plan slurm --shards 200 --out plan",
        "make a job array for a cluster; plan/submit submits it"}});
  command->callback([options, command, &globals, &action] {
    const bool gives_jobs = command->get_option("--jobs")->count() > 0;
    if (!options->plan.empty() && !gives_jobs) options->jobs = 1;
    action = [=, &globals] { return sweep_command(*options, globals); };
  });
}

void add_schedule(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<ScheduleOptions>();
  CLI::App* command =
      app.add_subcommand("schedule",
                         "Simulate how other tasks delay the loop on one or two CPUs with fixed "
                         "priorities, and fly with these delays");
  command
      ->add_option("tasks", options->tasks, "The task file, with [task.unit] and the other tasks")
      ->type_name("TASKS.toml")
      ->required();
  command
      ->add_option("--case", options->case_name,
                   "The flight: the name or id of a case, or a case file")
      ->type_name("CASE")
      ->capture_default_str();
  add_plant(*command, options->vehicle, options->plant);
  add_port(*command, globals, options->host);
  command
      ->add_option("--record-timing", options->record_timing,
                   "Write the times of all ticks, for `run --timing` and `sim --timing`")
      ->type_name("F")
      ->group(option_group::reports);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest schedule TASKS.toml --port lib:./libmine.so",
                           "print the worst response times, and fly with the delays"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return schedule_command(*options, globals); };
  });
}

void add_time(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<TimeCommandOptions>();
  CLI::App* command =
      app.add_subcommand("time",
                         "Measure the execution time and the stack use of a port's steps in the "
                         "open-loop vectors");
  add_port(*command, globals, options->host);
  add_selection(*command, options->select, Selects::open_loop);
  command
      ->add_option("--repeat", options->measure.repeats,
                   "Number of runs of each vector; the shortest time of each step counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI::Option* const budget =
      command
          ->add_option("--budget", options->measure.budget_us,
                       "Fail if a step takes longer than this [us]; default: no limit")
          ->check(CLI::PositiveNumber);
  command->add_option("--allow", options->allowed, "Number of steps that may exceed --budget")
      ->check(CLI::NonNegativeNumber)
      ->needs(budget)
      ->capture_default_str();
  command
      ->add_option("--worst", options->measure.worst,
                   "Write the trace of the vector with the slowest step, up to that step, for "
                   "`attest replay`")
      ->type_name("F.csv");
  command->add_flag("--instructions", options->instructions,
                    "Count the instructions of the steps of the slowest vector with valgrind; "
                    "default: off");
  command->add_flag("--stack,!--no-stack", options->measure.stack,
                    "Measure the largest stack use of a step, in one more run of each vector; "
                    "default: on");
  add_page(*command, options->html,
           "a page with the times by group and rate, and with the slowest vectors");
  command
      ->add_option("--json", options->json,
                   "Write the times and the stack use of each vector as JSON")
      ->type_name("F")
      ->group(option_group::reports);
  add_timeout(*command, options->host.timeout_s);
  command
      ->add_flag("--in-process", options->host.in_process,
                 "Run the port in attest's own process, for valgrind, perf or a debugger")
      ->group(option_group::execution);
  add_examples(*command, {{"attest time --port lib:./libmine.so --worst slowest.csv",
                           "write the trace with the slowest step"},
                          {"attest time --port lib:./libmine.so --budget 20 --rate 250",
                           "fail if a step takes more than 20 us"},
                          {"attest time --port lib:./libmine.so --profile px4-v1.16.0",
                           "measure the attitude unit and the rate unit, with a row for each"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return time_command(*options, globals); };
  });
}

}  // namespace

void add_timing_commands(CLI::App& app, const Globals& globals, Action& action) {
  add_stress(app, globals, action);
  add_sweep(app, globals, action);
  add_sweep_rate(app, globals, action);
  add_schedule(app, globals, action);
  add_time(app, globals, action);
}

}  // namespace attest::cli
