#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/casefile/parse_limits.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/casefile/task_set.hpp"
#include "harness/cli/find_case.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/core/file.hpp"
#include "harness/core/json_reader.hpp"
#include "harness/core/json_text.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/loop/scheduled_timing.hpp"
#include "harness/report/schedule_text.hpp"
#include "harness/verify/case_job.hpp"

namespace attest::cli {
namespace {

struct ScheduleOptions {
  std::string tasks;  // file
  std::string times;  // file of `attest time --json`; empty: the execution times of the task file
  CaseChoice flight{"flight/tilt_step_30", ""};
  std::string vehicle, plant;
  HostOptions host;
  std::string record_timing;
};

// The timing of a flight in which units and estimator run at the times of their simulated jobs.
FlightTiming timing_of(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs) {
  const std::vector<TaskJob>* estimator = set.estimator ? &jobs[*set.estimator] : nullptr;
  if (!set.attitude_unit) return scheduled_timing(jobs[set.unit], estimator);
  return scheduled_cascade(jobs[set.unit], jobs[*set.attitude_unit], estimator);
}

Result<void> check_law(const ScheduleOptions& options, const TaskSet& set, const Case& the_case) {
  if (set.attitude_unit.has_value() == the_case.attitude_loop.has_value()) return {};
  return fail_at(
      options.tasks,
      set.attitude_unit
          ? fmt::format("has [task.attitude_unit], but {} is a flight of v1.5.5 or v1.3.4, "
                        "whose controller is one unit: [task.unit]",
                        the_case.id())
          : fmt::format("needs [task.attitude_unit] too: {} is a flight of the cascade, "
                        "whose rate unit is [task.unit]",
                        the_case.id()));
}

struct SchedulePlan {
  HostOptions host;
  TaskSet set;
  std::vector<std::vector<TaskJob>> jobs;
  Jobs<VectorResult> flights;  // two flights: with every tick in time, and as scheduled
  TimingFile scheduled;
};

// The slowest step of each module. Errors: no report of `attest time`; it counts instructions,
// which have no duration.
Result<std::optional<UnitExecution>> measured_times(const std::string& file) {
  if (file.empty()) return std::optional<UnitExecution>();
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  const auto json = parse_json(*text, file);
  if (!json) return tl::unexpected(json.error());
  std::string error;
  JsonReader report(*json, error);
  if (!json->is_object() || !report.has("schema") || report.text("schema") != "attest-time-1") {
    return fail_at(file, "is no report of `attest time --json`");
  }
  constexpr std::int64_t most_ns = 3'600'000'000'000;
  UnitExecution measured;
  for (const auto& [name, figures] : report.member("modules").items()) {
    const auto module = module_named(name);
    if (!module) report.wrong("modules", fmt::format("has the unknown module {}", name));
    JsonReader reader(figures, error);
    if (!reader.has("max_ns")) {
      return fail_at(file, "has no times: its port counts instructions, which have no duration");
    }
    const Nanoseconds slowest(reader.integer("max_ns", 0, most_ns));
    if (module) measured[*module] = slowest;
  }
  if (!error.empty()) return fail_at(file, error);
  return std::optional(std::move(measured));
}

Result<SchedulePlan> make_plan(const ScheduleOptions& options, const SuiteFolder& suite) {
  const auto measured = measured_times(options.times);
  if (!measured) return tl::unexpected(measured.error());
  auto set = read_task_set(options.tasks, *measured);
  if (!set) return tl::unexpected(set.error());
  const auto chosen =
      choose_flight(options.flight, set->rate(), options.vehicle, options.plant, suite);
  if (!chosen) return tl::unexpected(chosen.error());
  SchedulePlan plan;
  plan.host = options.host;
  if (auto port = prepare_port(plan.host); !port) return tl::unexpected(port.error());

  const Case& the_case = chosen->the_case;
  if (auto checked = check_law(options, *set, the_case); !checked) {
    return tl::unexpected(checked.error());
  }
  if (auto few = check_ticks(the_case, set->rate()); !few) return tl::unexpected(few.error());
  const RunConfiguration configuration{set->rate(), chosen->plant_configuration};
  const Nanoseconds duration = timeline_of(the_case, configuration.rate.motor_unit).duration;
  auto jobs = simulate(set->tasks, duration);
  if (!jobs) return fail_at(options.tasks, jobs.error().message);
  plan.scheduled = {the_case.id(), the_case.sha256, configuration, in_seconds(duration),
                    timing_of(*set, *jobs)};
  if (set->attitude_unit && plan.scheduled.ticks.attitude_unit.empty()) {
    return fail_at(options.tasks, "[task.attitude_unit] has no job within the flight");
  }
  TimingFile in_time = plan.scheduled;
  in_time.ticks = flight_timing(the_case, configuration.rate);
  for (const TimingFile& timing : {in_time, plan.scheduled}) {
    plan.flights.push_back(std::make_unique<TimedJob>(the_case, timing, chosen->vehicle_model,
                                                      JudgeOptions{}, plan.host));
  }
  plan.set = std::move(*set);
  plan.jobs = std::move(*jobs);
  return plan;
}

int schedule_command(const ScheduleOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  const auto checked = check_outputs(
      {options.record_timing},
      {options.host.port, {options.tasks, options.times, options.flight.name}}, globals.suite);
  if (!checked) return report_error(checked.error());
  auto timing = AtomicFile::open(options.record_timing);
  if (!timing) return report_error(timing.error());
  const auto plan = make_plan(options, *suite);
  if (!plan) return report_error(plan.error());
  if (!globals.quiet) {
    fmt::print("{}\n{}\n", render_tasks(plan->set, plan->jobs),
               render_delays(plan->set, plan->jobs, plan->scheduled.ticks));
  }
  if (!options.record_timing.empty()) {
    if (auto written = write_timing(plan->scheduled, *std::move(timing)); !written) {
      return report_error(written.error());
    }
  }
  const JobResults<VectorResult> outcome = run_jobs(plan->flights, JobOptions<VectorResult>());
  if (!outcome.errors.empty()) return report_error(outcome.errors.front());
  if (auto same = check_port(plan->host); !same) return report_error(same.error());
  const VectorResult& scheduled = outcome.results[1];
  if (!globals.quiet) fmt::print("{}", render_flights(outcome.results[0], scheduled));
  for (const VectorResult& result : outcome.results) {
    if (fails_a_run(result.verdict)) return exit_failed;
    if (result.verdict != Verdict::pass) {
      return report_error(
          supported_instead(options.host, {result.profile}, hover_command("attest sim", {}, "", ""))
              .value_or(Error{fmt::format("no flight took place: {}", result.reason)}));
    }
  }
  return exit_ok;
}

}  // namespace

void add_schedule(const CommandLine& line) {
  auto options = std::make_shared<ScheduleOptions>();
  const Command command =
      line.add("schedule",
               "Simulate how other tasks delay the loop on one or two CPUs with fixed "
               "priorities, and fly with these delays");
  command
      .option("tasks", options->tasks,
              "The task file, with [task.unit] and the other tasks; docs/timing.md has an example")
      .type("TASKS.toml")
      .required();
  command
      .option("--times", options->times,
              "Report of `attest time --json`: the slowest steps are the execution times of the "
              "units, in place of `execution_us`")
      .type("F.json");
  add_case(command, options->flight);
  add_plant(command, options->vehicle, options->plant);
  add_port(command, options->host);
  command
      .option("--record-timing", options->record_timing,
              "Write the times of all ticks, for `run --timing` and `sim --timing`")
      .type("F")
      .group(option_group::reports);
  add_timeout(command, options->host.timeout_s);
  command.examples({{"attest schedule TASKS.toml --port lib:./libmine.so",
                     "print the worst response times, and fly with the delays"},
                    {"attest schedule TASKS.toml --times t.json",
                     "take the execution time of the units from `attest time --json t.json`"}});
  command.runs(options, schedule_command);
}

}  // namespace attest::cli
