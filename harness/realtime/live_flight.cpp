#include "harness/realtime/live_flight.hpp"

#include <algorithm>
#include <memory>
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
constexpr auto settle_in = std::chrono::milliseconds(20);  // for the start of threads before time 0
constexpr auto progress_every = std::chrono::milliseconds(100);
constexpr std::size_t step_stack_bytes = 256 * 1024;  // a step may use it without a page fault

// Touches the stack below this frame, because the kernel maps each page at its first use.
void touch_stack() {
  volatile unsigned char pages[step_stack_bytes];
  for (std::size_t at = 0; at < step_stack_bytes; at += 4096) pages[at] = 0;
  static_cast<void>(pages[0]);
}

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

LoopTiming timing_of(const LiveUnitRecord& unit) {
  LoopTiming timing;
  timing.reserve(unit.ticks.size());
  for (const LiveTick& tick : unit.ticks) {
    const bool was_used = tick.commanded >= Nanoseconds(0);
    timing.push_back(
        {tick.sampled, tick.begins, was_used ? std::optional(tick.commanded) : std::nullopt});
  }
  return timing;
}

LivePlantPlan plan_of(const Case& scripted, const Rate& rate, std::size_t ticks) {
  const Timeline timeline = timeline_of(scripted, rate);
  LivePlantPlan plan{physics_of(scripted, rate), timeline.duration, ticks, {}, {}, {}, {}};
  if (const auto& battery = scripted.flight->battery) {
    plan.battery_times = task_times(battery->timing, timeline);
  }
  if (scripted.unit.on_estimate) plan.estimator = rate;
  if (scripted.attitude_loop && scripted.flight->floor) {
    plan.land_detector.emplace(scripted, rate);
    plan.landing_times = task_times(land_detection(), timeline);
  }
  return plan;
}

struct UnitSetting {
  const Case& scripted;  // of the whole flight
  const LoopRate& rate;
  const Vehicle& vehicle;
  PlantState start;
  Pacer clock;
  std::size_t samples;
};

struct FlyingUnit {
  FlyingUnit(Module module, Unit& port, const UnitSetting& setting, Links& links)
      : scripted(setting.scripted.of_module(module)),
        task(scripted, setting.rate.motor_unit, setting.vehicle, port,
             Estimate{Nanoseconds(0), control_state_of(setting.start)}),
        clock(setting.clock),
        live(scripted, setting.rate, task, clock, links, setting.samples) {}

  Case scripted;
  UnitTask task;
  Pacer clock;
  LiveUnit live;
  std::vector<RealtimePrivilege> privileges;  // of its thread
};

// The plant and the units, before their threads start. Must not move, because the members refer to
// each other.
struct Flyers {
  // REQUIRES: same as fly_live(); `scripted` is bound to the vehicle. All outlive this.
  Flyers(const Case& scripted, const LoopRate& rate, const Vehicle& vehicle, Plant& flown,
         FlightUnits units, const LivePlan& plan)
      : plant_task(scripted, rate.motor_unit, vehicle, flown),
        origin(Pacer::now_monotonic() + settle_in),
        setting{scripted,    rate, vehicle, plant_task.state(), {origin, plan.options.wait},
                plan.samples},
        unit(scripted.module, units.unit, setting, links),
        attitude_unit(scripted.attitude_loop
                          ? std::make_unique<FlyingUnit>(Module::attitude_unit,
                                                         *units.attitude_unit, setting, links)
                          : nullptr),
        plant_clock(origin, Wait{}),
        plant(plant_task, plan_of(scripted, rate.motor_unit, unit.live.deadlines()), plant_clock,
              links) {
    links.flying = attitude_unit ? 2 : 1;
  }

  Links links;
  PlantTask plant_task;
  Nanoseconds origin;  // time 0 of all clocks
  UnitSetting setting;
  FlyingUnit unit;  // the one that commands the motors
  std::unique_ptr<FlyingUnit> attitude_unit;
  Pacer plant_clock;
  LivePlant plant;
  std::vector<RealtimePrivilege> plant_privileges;  // of its thread
};

std::thread start(FlyingUnit& unit, const LiveOptions& options, int priority) {
  return std::thread([&unit, wish = unit_wish(options, priority)] {
    run_claimed(wish, unit.privileges, [&unit] { unit.live.run(); });
  });
}

std::vector<std::thread> start(Flyers& flyers, const LiveOptions& options) {
  std::vector<std::thread> threads;
  threads.emplace_back([&flyers, wish = plant_wish(options)] {
    run_claimed(wish, flyers.plant_privileges, [&flyers] { flyers.plant.run(); });
  });
  threads.push_back(start(flyers.unit, options, unit_priority));
  if (flyers.attitude_unit) {
    threads.push_back(start(*flyers.attitude_unit, options, attitude_unit_priority));
  }
  return threads;
}

LiveProgress progress_at(Nanoseconds now, const Flyers& flyers) {
  const LiveUnit& unit = flyers.unit.live;
  LiveProgress progress{now, unit.releases_passed(), unit.missed()};
  if (flyers.attitude_unit) {
    progress.deadlines += flyers.attitude_unit->live.releases_passed();
    progress.missed += flyers.attitude_unit->live.missed();
  }
  return progress;
}

void look_after(Flyers& flyers, const LiveWatch& watch) {
  Pacer here(flyers.origin, Wait{});
  here.wait_until(Nanoseconds(0));
  while (!flyers.links.stop.load()) {
    if (watch.stop()) flyers.links.stop.store(true);
    watch.progress(progress_at(here.now(), flyers));
    std::this_thread::sleep_for(progress_every);
  }
}

void add_refused(const std::vector<RealtimePrivilege>& from, std::vector<RealtimePrivilege>& to) {
  std::copy_if(from.begin(), from.end(), std::back_inserter(to),
               [](const RealtimePrivilege& right) { return !right.got; });
}

std::vector<RealtimePrivilege> privileges_of(const ProcessPrivileges& process,
                                             const Flyers& flyers) {
  std::vector<RealtimePrivilege> all = process.privileges();
  all.insert(all.end(), flyers.unit.privileges.begin(), flyers.unit.privileges.end());
  if (flyers.attitude_unit) add_refused(flyers.attitude_unit->privileges, all);
  add_refused(flyers.plant_privileges, all);
  return all;
}

void set_commanded(const std::vector<std::optional<Nanoseconds>>& times,
                   std::vector<LiveTick>& ticks) {
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ticks[i].commanded = times[i].value_or(Nanoseconds(-1));
  }
}

// REQUIRES: the threads have ended.
LiveFlight flight_of(Flyers& flyers, const ProcessPrivileges& process) {
  LiveFlight flight;
  flight.unit = flyers.unit.live.take_record();
  flight.plant = flyers.plant.take_record();
  if (flyers.attitude_unit) flight.attitude_unit = flyers.attitude_unit->live.take_record();
  set_commanded(std::exchange(flight.plant.commanded, {}), flight.unit.ticks);
  if (auto& attitude = flight.attitude_unit) {
    set_commanded(std::exchange(flight.unit.setpoints_received, {}), attitude->ticks);
  }
  flight.privileges = privileges_of(process, flyers);
  return flight;
}

}  // namespace

FlightTiming LiveFlight::timing() const {
  FlightTiming timing = timing_of(unit);
  if (attitude_unit) timing.attitude_unit = timing_of(*attitude_unit);
  return timing;
}

Result<LiveFlight> fly_live(const Case& the_case, const LivePlan& plan,
                            const VehicleModel& vehicle_model, FlightUnits units,
                            const LiveWatch& watch) {
  auto plant = plant_for(the_case, plan.configuration, vehicle_model);
  if (!plant) return tl::unexpected(plant.error());
  const Vehicle& vehicle = vehicle_model.vehicle();
  const Case scripted = bound_to_vehicle(the_case, vehicle);
  const ProcessPrivileges process;
  Flyers flyers(scripted, plan.configuration.rate, vehicle, **plant, units, plan);
  std::vector<std::thread> threads = start(flyers, plan.options);
  look_after(flyers, watch);
  for (std::thread& thread : threads) thread.join();
  return flight_of(flyers, process);
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
        // Leaves out releases that have passed by now: they have no wake-up of their own.
        k = std::max(k, rate.ticks_in(woke + Nanoseconds(1)) - 1);
      }
    });
  });
  thread.join();
  return latency;
}

}  // namespace attest
