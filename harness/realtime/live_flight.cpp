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
constexpr int unit_priority = 80, plant_priority = 79;
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

ThreadWish unit_wish(const LiveOptions& options) {
  return {options.unit_cpu, options.fifo ? unit_priority : 0};
}

ThreadWish plant_wish(const LiveOptions& options) {
  return {options.plant_cpu, options.fifo ? plant_priority : 0};
}

}  // namespace

LoopTiming LiveFlight::timing() const {
  LoopTiming timing;
  timing.reserve(unit.ticks.size());
  for (std::size_t i = 0; i < unit.ticks.size(); ++i) {
    timing.push_back({unit.ticks[i].sampled, unit.ticks[i].begins, plant.commanded[i]});
  }
  return timing;
}

Result<LiveFlight> fly_live(const Case& the_case, const RunConfiguration& configuration,
                            const VehicleModel& vehicle_model, Unit& unit,
                            const LiveOptions& options, std::size_t samples,
                            const std::function<bool()>& stop,
                            const std::function<void(const LiveProgress&)>& progress) {
  auto plant = plant_for(the_case, configuration, vehicle_model);
  if (!plant) return tl::unexpected(plant.error());
  const Case scripted = bound_to_vehicle(the_case, vehicle_model.vehicle());
  const Rate& rate = configuration.rate.unit;
  const Timeline timeline = timeline_of(scripted, rate);

  ProcessPrivileges process;
  Links links;
  PlantTask plant_task(scripted, rate, vehicle_model.vehicle(), **plant);
  UnitTask unit_task(scripted, rate, vehicle_model.vehicle(), unit,
                     Estimate{Nanoseconds(0), control_state_of(plant_task.state())});
  const Nanoseconds origin = Pacer::now_monotonic() + settle_in;
  Pacer unit_clock(origin, options.wait), plant_clock(origin, Wait{});
  LiveUnit live_unit(scripted, rate, unit_task, unit_clock, links, samples);
  LivePlantPlan plan{physics_of(scripted, rate), timeline.duration, live_unit.deadlines(), {}, {}};
  if (const auto& battery = scripted.flight->battery) {
    plan.battery_times = task_times(battery->timing, timeline);
  }
  if (scripted.unit.on_estimate) plan.estimator = rate;
  LivePlant live_plant(plant_task, std::move(plan), plant_clock, links);

  std::vector<RealtimePrivilege> unit_privileges, plant_privileges;
  std::thread plant_thread(
      [&] { run_claimed(plant_wish(options), plant_privileges, [&] { live_plant.run(); }); });
  std::thread unit_thread(
      [&] { run_claimed(unit_wish(options), unit_privileges, [&] { live_unit.run(); }); });
  Pacer here(origin, Wait{});
  here.wait_until(Nanoseconds(0));
  while (!links.stop.load()) {
    if (stop()) links.stop.store(true);
    progress({here.now(), live_unit.releases_passed(), live_unit.missed()});
    std::this_thread::sleep_for(progress_every);
  }
  unit_thread.join();
  plant_thread.join();

  LiveFlight flight{live_unit.take_record(), live_plant.take_record(), process.privileges(), {}};
  if (!flight.unit.ticks.empty()) flight.wall = flight.unit.ticks.back().begins;
  flight.privileges.insert(flight.privileges.end(), unit_privileges.begin(), unit_privileges.end());
  std::copy_if(plant_privileges.begin(), plant_privileges.end(),
               std::back_inserter(flight.privileges),
               [](const RealtimePrivilege& right) { return !right.got; });
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
