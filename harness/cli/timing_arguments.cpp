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
                  "Scheduling policy of unit and plant: `fifo` (where it is permitted) or `other`")
      ->type_name("POLICY")
      ->capture_default_str()
      ->group(option_group::execution);
  command
      .add_option("--cpus", options.cpus, "2: unit and plant have a CPU each; 1: they share one")
      ->check(CLI::Range(1, 2))
      ->capture_default_str()
      ->group(option_group::execution);
  command
      .add_option("--spin", options.spin_us,
                  "The unit wakes up this time [us] before each release, and spins until the "
                  "release")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str()
      ->group(option_group::execution);
  command
      .add_flag("--cyclictest,!--no-cyclictest", options.cyclictest,
                "Let cyclictest measure the idle machine too, where it is installed (on by "
                "default)")
      ->group(option_group::execution);
}

void add_budgets(CLI::App& command, StressOptions& options) {
  command
      .add_option("--misses-per-million", options.misses_per_million,
                  "Deadline misses allowed, and also overruns, counted separately; replaces "
                  "the bound of the case")
      ->check(CLI::NonNegativeNumber)
      ->group(option_group::strictness);
  command
      .add_option("--p99-latency", options.p99_latency_us,
                  "Wake-up latency that 1% of the steps may exceed [us]; replaces that of the case")
      ->check(CLI::NonNegativeNumber)
      ->group(option_group::strictness);
  command
      .add_option(
          "--budget", options.execution_us,
          "Execution time [us]; a longer step is an overrun. The limit of deadline misses also "
          "applies to overruns")
      ->check(CLI::NonNegativeNumber)
      ->group(option_group::strictness);
}

void add_stress_reports(CLI::App& command, StressOptions& options) {
  command
      .add_option("--record-timing", options.record_timing,
                  "Write the times of all ticks, for `run --timing` and `sim --timing`; one "
                  "rate only")
      ->type_name("F")
      ->group(option_group::reports);
  add_page(command, options.html,
           "A page with the distributions of the times, those of the idle machine, and a timeline");
  command.add_option("--json", options.json, "Write all measurements")
      ->type_name("F")
      ->group(option_group::reports);
  command.add_option("--junit", options.junit, "Write a report for CI servers")
      ->type_name("F")
      ->group(option_group::reports);
}

void add_stress(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<StressOptions>();
  CLI::App* command = app.add_subcommand("stress",
                                         "Let a port fly in real time, at each loop rate: latency, "
                                         "execution time, response time, misses");
  add_port(*command, options->host.port);
  add_rates(*command, options->rates,
            "Loop rates [Hz], separated by commas; for v1.14 to v1.16 pairs such as 250:1000")
      ->default_str("250,500,1000,2000,4000,8000");
  command->add_option("--duration", options->duration_s, "Duration of the flight at each rate [s]")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_option("--case", options->case_name, "A flight: its name or id, or a case file")
      ->type_name("CASE")
      ->capture_default_str();
  add_plant(*command, options->vehicle, options->plant);
  add_machine(*command, *options);
  add_budgets(*command, *options);
  add_stress_reports(*command, *options);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command,
               {{"attest stress --port lib:./libmine.so", "at 250 Hz to 8 kHz, 10 s each"},
                {"attest stress --port lib:./libmine.so --rate 1000 --load 2 --load-kind cache",
                 "while two processes fill the caches"},
                {"attest stress --case hover --rate 250:1000",
                 "the attitude unit at 250 Hz and the rate unit at 1 kHz, with a result each"},
                {"attest stress --rate 500 --duration 5 --record-timing t.json",
                 "keep the times, to fly them again with `attest run --timing t.json`"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return stress_command(*options, globals); };
  });
}

void add_sweep_rate(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<RateSweepOptions>();
  CLI::App* command = app.add_subcommand("sweep-rate",
                                         "For each vehicle: the lowest loop rate, and the largest "
                                         "delay of the motor commands, at which "
                                         "the metrics of a flight are within their bounds");
  command->add_option("--case", options->case_name, "A flight; the bounds are those of its metrics")
      ->type_name("CASE")
      ->capture_default_str();
  add_rates(*command, options->rates,
            "Loop rates at which to find the largest delay [Hz]; for v1.14 to v1.16 pairs such as "
            "250:1000")
      ->default_str("50,100,250,500,1000");
  command->add_option("--vehicle", options->vehicles, "Only this vehicle")
      ->type_name("VEHICLE")
      ->allow_extra_args(false);
  command->add_option("--plant", options->plants, "Only on this plant: `mujoco` or `ode`")
      ->type_name("PLANT")
      ->allow_extra_args(false);
  add_port(*command, options->host.port);
  add_page(*command, options->html, "A page with maps of the limits, and of the metrics by rate");
  command->add_option("--csv", options->csv, "Write the table")
      ->type_name("F.csv")
      ->group(option_group::reports);
  add_timeout(*command, options->host.timeout_s);
  add_jobs(*command, options->jobs, "Number of vehicles that fly at the same time");
  add_examples(*command,
               {{"attest sweep-rate --port lib:./libmine.so --vehicle iris",
                 "the lowest rate and the largest delay with which the Iris flies within bounds"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return sweep_rate_command(*options, globals); };
  });
}

void add_sweep_parts(CLI::App& command, SweepOptions& options) {
  command
      .add_option(
          "--samples", options.samples,
          "Number of samples; replaces that of the file. All samples depend on this number, so "
          "a sweep with a larger number does not continue one with a smaller number")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  CLI::Option* const shard =
      command.add_option("--shard", options.shard, "Fly only part I of N of the samples")
          ->type_name("I/N")
          ->capture_default_str();
  command
      .add_option("--merge", options.merge,
                  "Fly nothing: join the shards in these folders; the result is that of one "
                  "machine")
      ->type_name("DIR...")
      ->excludes(shard);
  command
      .add_option("--keep-worst", options.keep_worst,
                  "Number of worst flights of each requirement to keep in OUT/worst, for "
                  "`attest sim`")
      ->check(CLI::Range(0, 1000))
      ->type_name("K")
      ->capture_default_str()
      ->group(option_group::reports);
}

void add_shard_plan(CLI::App& command, SweepOptions& options) {
  CLI::Option* const plan =
      command
          .add_option(
              "--plan", options.plan,
              "Fly nothing: write to OUT the files with which many machines fly the shards of "
              "the sweep, and merge them: `slurm` (a job array), `parallel` (GNU "
              "parallel), `github` or `gitlab` (jobs of CI)")
          ->type_name("KIND")
          ->group(option_group::execution);
  CLI::Option* const shards =
      command.add_option("--shards", options.shards, "Number of shards of the plan")
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
      "Fly a case many times with dispersed values. Estimates the probability that a flight meets "
      "each requirement, and tests whether a port flies like the reference");
  command
      ->add_option("file", options->file,
                   "The sweep (TOML): case, dispersions, design, requirements")
      ->type_name("SWEEP.toml")
      ->required();
  add_plant(*command, options->vehicle, options->plant, "that of the file", "that of the file");
  add_port(*command, options->host.port);
  command
      ->add_option("--out", options->out,
                   "Folder of the results: samples.csv, report.json. If it has the results of an "
                   "interrupted sweep, only the missing samples are flown")
      ->type_name("DIR")
      ->required()
      ->group(option_group::reports);
  add_sweep_parts(*command, *options);
  command
      ->add_option(
          "--hdf5", options->hdf5,
          "Write the results as columns in an HDF5 file, for large sweeps; needs memory of "
          "about three times the size of the table, which has 8 bytes for each number")
      ->type_name("F.h5")
      ->group(option_group::reports);
  add_page(*command, options->html,
           "A page with the requirements, distributions, sensitivities and worst flights");
  add_shard_plan(*command, *options);
  add_timeout(*command, options->host.timeout_s);
  // add_jobs() appends "; default: one for each CPU".
  add_jobs(*command, options->jobs,
           "Number of samples that fly at the same time (with --plan: in each shard, 1 by "
           "default)");
  add_examples(
      *command,
      {{"attest sweep SWEEP.toml --out results --keep-worst 3 --html sweep.html",
        "fly the reference, keep the three worst flights of each requirement, and write a page"},
       {"attest sweep SWEEP.toml --port lib:./libmine.so --out results",
        "fly port and reference on the same samples, and test whether they differ"},
       {"attest sweep SWEEP.toml --out results --hdf5 results.h5",
        "also write the numbers as binary columns; a complete sweep is not flown again"},
       {"attest sweep SWEEP.toml --shard 2/4 --out part2", "the second quarter of the samples"},
       {"attest sweep SWEEP.toml --merge part1 part2 part3 part4 --out results",
        "the result of all samples"},
       {"attest sweep SWEEP.toml --plan slurm --shards 200 --out plan",
        "a job array for a cluster; plan/submit submits it"}});
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
                         "Simulate how other tasks delay the loop: response times with fixed "
                         "priorities on one or two CPUs, and a flight with these delays");
  command->add_option("tasks", options->tasks, "The tasks (TOML): [task.unit] and the others")
      ->type_name("TASKS.toml")
      ->required();
  command->add_option("--case", options->case_name, "A flight: its name or id, or a case file")
      ->type_name("CASE")
      ->capture_default_str();
  add_plant(*command, options->vehicle, options->plant);
  add_port(*command, options->host.port);
  command
      ->add_option("--record-timing", options->record_timing,
                   "Write the times of all ticks, for `run --timing` and `sim --timing`")
      ->type_name("F")
      ->group(option_group::reports);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest schedule TASKS.toml --port lib:./libmine.so",
                           "worst response times of the tasks, and a flight with these delays"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return schedule_command(*options, globals); };
  });
}

void add_time(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<TimeCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "time",
      "Measure the execution times and the stack use of a port's steps over all vectors, and find "
      "the slowest input");
  add_port(*command, options->host.port);
  add_selection(*command, options->select);
  command
      ->add_option(
          "--repeat", options->measure.repeats,
          "Runs of each vector; the shortest time of each step counts, because the machine "
          "can only add to it")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI::Option* const budget = command
                                  ->add_option("--budget", options->measure.budget_us,
                                               "Fail when steps take longer than this [us]")
                                  ->check(CLI::PositiveNumber);
  command->add_option("--allow", options->allowed, "Number of steps that may be over the budget")
      ->check(CLI::NonNegativeNumber)
      ->needs(budget)
      ->capture_default_str();
  command
      ->add_option("--worst", options->measure.worst,
                   "Write the vector that contains the slowest step, up to that step, for "
                   "`attest replay`")
      ->type_name("F.csv");
  command->add_flag("--instructions", options->instructions,
                    "Count the instructions of the slowest vector's steps, with valgrind");
  command->add_flag(
      "--stack,!--no-stack", options->measure.stack,
      "Measure the most stack that a step uses, in one more run of each vector (on by "
      "default)");
  add_page(*command, options->html,
           "A page with the distribution of the times, by group and rate, and the slowest vectors");
  command->add_option("--json", options->json, "Write all times and stack use, by vector")
      ->type_name("F")
      ->group(option_group::reports);
  add_timeout(*command, options->host.timeout_s);
  command
      ->add_flag("--in-process", options->host.in_process,
                 "Run the port in attest's own process: for valgrind, perf or a debugger")
      ->group(option_group::execution);
  add_examples(*command, {{"attest time --port lib:./libmine.so --worst slowest.csv",
                           "the slowest step of all vectors, written for `attest replay`"},
                          {"attest time --port lib:./libmine.so --budget 20 --rate 250",
                           "fail if a step takes more than 20 us"},
                          {"attest time --port lib:./libmine.so --profile px4-v1.16.0",
                           "the attitude unit and the rate unit, in a row each"}});
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
