#include "harness/realtime/live_flight.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "harness/casefile/stimulus.hpp"
#include "harness/core/float_environment.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/loop/flight.hpp"

namespace attest {
namespace {

// Above the kernel's own threads of priority 50, below its watchdogs of 99.
constexpr int unit_priority = 80, attitude_unit_priority = 79, plant_priority = 78;
constexpr auto settle_in = std::chrono::milliseconds(20);  // from the start of threads to time 0
constexpr auto progress_every = std::chrono::milliseconds(100);
constexpr std::size_t stack_bytes = 256 * 1024;  // what a step may use without a page fault

// Touches the stack below, which is mapped page by page as it is first used.
void touch_stack() {
  volatile unsigned char pages[stack_bytes];
  for (std::size_t at = 0; at < stack_bytes; at += 4096) pages[at] = 0;
  static_cast<void>(pages[0]);
}

// The body of a real-time thread: claims its privileges, gets its memory ready, does its work.
template <typename Work>
void run_claimed(const ThreadWish& wish, std::vector<RealtimePrivilege>& privileges, Work&& work) {
  const DefaultFloatEnvironment environment;
  privileges = claim(wish);
  touch_stack();
  work();
}

ThreadWish unit_wish(const LiveOptions& options, int priority = unit_priority) {
  return {options.unit_cpu, options.fifo ? priority : 0};
}

ThreadWish plant_wish(const LiveOptions& options) {
  return {options.plant_cpu, options.fifo ? plant_priority : 0};
}

LoopTiming timing_of(const LiveUnitRecord& unit,
                     const std::vector<std::optional<Nanoseconds>>& commanded) {
  LoopTiming timing;
  timing.reserve(unit.ticks.size());
  for (std::size_t i = 0; i < unit.ticks.size(); ++i) {
    timing.push_back({unit.ticks[i].sampled, unit.ticks[i].begins, commanded[i]});
  }
  return timing;
}

// A unit with its clock; its thread runs it.
struct FlyingUnit {
  FlyingUnit(const Case& the_case, const LoopRate& rate, const Vehicle& vehicle, Unit& port,
             const PlantState& start, Pacer own_clock, Links& links, std::size_t samples)
      : scripted(the_case),
        task(scripted, rate.unit, vehicle, port, Estimate{Nanoseconds(0), control_state_of(start)}),
        clock(own_clock),
        live(scripted, rate, task, clock, links, samples) {}

  Case scripted;
  UnitTask task;
  Pacer clock;
  LiveUnit live;
  std::vector<RealtimePrivilege> privileges;
};

LivePlantPlan plan_of(const Case& scripted, const Rate& rate, const Vehicle& vehicle,
                      std::size_t ticks) {
  const Timeline timeline = timeline_of(scripted, rate);
  LivePlantPlan plan{physics_of(scripted, rate), timeline.duration, ticks, {}, {}, {}, {}};
  if (const auto& battery = scripted.flight->battery) {
    plan.battery_times = task_times(battery->timing, timeline);
  }
  if (scripted.unit.on_estimate) plan.estimator = rate;
  if (scripted.attitude_loop && scripted.flight->floor) {
    plan.land_detector.emplace(vehicle, true);
    plan.landing_times = task_times(land_detection(), timeline);
  }
  return plan;
}

void add_refused(const std::vector<RealtimePrivilege>& from, std::vector<RealtimePrivilege>& to) {
  std::copy_if(from.begin(), from.end(), std::back_inserter(to),
               [](const RealtimePrivilege& right) { return !right.got; });
}

}  // namespace

FlightTiming LiveFlight::timing() const {
  FlightTiming timing = timing_of(unit, plant.commanded);
  if (attitude_unit) timing.attitude_unit = timing_of(*attitude_unit, unit.setpoints_received);
  return timing;
}

Result<LiveFlight> fly_live(const Case& the_case, const RunConfiguration& configuration,
                            const VehicleModel& vehicle_model, FlightUnits units,
                            const LiveOptions& options, std::size_t samples,
                            const std::function<bool()>& stop,
                            const std::function<void(const LiveProgress&)>& progress) {
  auto plant = plant_for(the_case, configuration, vehicle_model);
  if (!plant) return tl::unexpected(plant.error());
  const Vehicle& vehicle = vehicle_model.vehicle();
  const Case scripted = bound_to_vehicle(the_case, vehicle);
  const LoopRate& rate = configuration.rate;

  ProcessPrivileges process;
  Links links;
  PlantTask plant_task(scripted, rate.unit, vehicle, **plant);
  const Nanoseconds origin = Pacer::now_monotonic() + settle_in;
  const Pacer unit_clock(origin, options.wait);
  FlyingUnit unit(scripted.of_module(scripted.module), rate, vehicle, units.unit,
                  plant_task.state(), unit_clock, links, samples);
  std::optional<FlyingUnit> attitude;
  if (scripted.attitude_loop) {
    attitude.emplace(scripted.of_module(Module::attitude_unit), rate, vehicle, *units.attitude_unit,
                     plant_task.state(), unit_clock, links, samples);
    links.flying = 2;
  }
  Pacer plant_clock(origin, Wait{});
  LivePlant live_plant(plant_task, plan_of(scripted, rate.unit, vehicle, unit.live.deadlines()),
                       plant_clock, links);

  std::vector<RealtimePrivilege> plant_privileges;
  std::vector<std::thread> threads;
  const auto start = [&](FlyingUnit& flying, int priority) {
    threads.emplace_back([&flying, &options, priority] {
      run_claimed(unit_wish(options, priority), flying.privileges, [&] { flying.live.run(); });
    });
  };
  threads.emplace_back(
      [&] { run_claimed(plant_wish(options), plant_privileges, [&] { live_plant.run(); }); });
  start(unit, unit_priority);
  if (attitude) start(*attitude, attitude_unit_priority);
  Pacer here(origin, Wait{});
  here.wait_until(Nanoseconds(0));
  while (!links.stop.load()) {
    if (stop()) links.stop.store(true);
    LiveProgress now{here.now(), unit.live.releases_passed(), unit.live.missed()};
    if (attitude) {
      now.deadlines += attitude->live.releases_passed();
      now.missed += attitude->live.missed();
    }
    progress(now);
    std::this_thread::sleep_for(progress_every);
  }
  for (std::thread& thread : threads) thread.join();

  LiveFlight flight{
      unit.live.take_record(), live_plant.take_record(), {}, process.privileges(), {}};
  if (attitude) flight.attitude_unit = attitude->live.take_record();
  if (!flight.unit.ticks.empty()) flight.wall = flight.unit.ticks.back().begins;
  flight.privileges.insert(flight.privileges.end(), unit.privileges.begin(), unit.privileges.end());
  if (attitude) add_refused(attitude->privileges, flight.privileges);
  add_refused(plant_privileges, flight.privileges);
  return flight;
}

Histogram idle_latency(const Rate& rate, Nanoseconds duration, const LiveOptions& options,
                       const std::function<bool()>& stop) {
  Histogram latency;
  std::vector<RealtimePrivilege> privileges;
  std::thread thread([&] {
    ProcessPrivileges process;
    run_claimed(unit_wish(options), privileges, [&] {
      Pacer clock(Pacer::now_monotonic() + settle_in, options.wait);
      for (std::int64_t k = 0; rate.tick(k) < duration && !stop(); ++k) {
        const Nanoseconds woke = clock.wait_until(rate.tick(k));
        latency.add(woke - rate.tick(k));
        // A release that was passed over has no wake-up of its own.
        k = std::max(k, rate.ticks_in(woke + Nanoseconds(1)) - 1);
      }
    });
  });
  thread.join();
  return latency;
}

}  // namespace attest
