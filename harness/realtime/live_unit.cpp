#include "harness/realtime/live_unit.hpp"

#include <algorithm>
#include <utility>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/case_timing.hpp"

namespace attest {
namespace {

template <typename T>
DelayLine<T> line(const TaskTiming& timing, const Rate& rate) {
  const Nanoseconds delay = timing.delay.on(rate);
  return {delay, static_cast<std::size_t>(timing.rate.ticks_in(delay)) + 2};
}

bool is_attitude(const UnitTask& task) { return task.module() == Module::attitude_unit; }

const Rate& own_rate(const UnitTask& task, const LoopRate& rate) {
  return is_attitude(task) ? *rate.attitude_unit : rate.motor_unit;
}

DelayLine<LiveRatesSetpoint> rates_setpoints(const Case& the_case, const LoopRate& rate) {
  if (!the_case.attitude_loop) return {Nanoseconds(0), 0};
  const Nanoseconds delay = the_case.attitude_loop->delay.on(rate.motor_unit);
  // After a late tick of the attitude unit the next tick follows at once. So the attitude unit may
  // make more setpoints within the delay than the delay has periods.
  return {delay, static_cast<std::size_t>(2 * rate.attitude_unit->ticks_in(delay)) + 2};
}

}  // namespace

LiveUnit::LiveUnit(const Case& the_case, const LoopRate& rate, UnitTask& task, Clock& clock,
                   Links& links, std::size_t samples)
    : task_(task),
      clock_(clock),
      links_(links),
      own_(is_attitude(task) ? links.attitude_unit : links.unit),
      commands_motors_(!is_attitude(task)),
      rate_(own_rate(task, rate)),
      on_estimate_(the_case.unit.on_estimate),
      deadlines_(tick_count(the_case.duration, rate_)),
      estimator_(the_case, rate_, rate.motor_unit),
      saturation_times_(
          task_times(the_case.flight->saturation, timeline_of(the_case, rate.motor_unit))),
      saturations_(line<Saturation>(the_case.flight->saturation, rate.motor_unit)),
      battery_scales_(
          line<float>(the_case.flight->battery.value_or(BatteryFlight{}).timing, rate.motor_unit)),
      rates_setpoints_(rates_setpoints(the_case, rate)) {
  const auto most = static_cast<std::size_t>(deadlines_);
  samples_max_ = std::min(samples, most);
  record_.ticks.resize(most);
  record_.samples.resize(samples_max_);
  if (the_case.attitude_loop && commands_motors_) {
    const auto ticks = tick_count(the_case.duration, *rate.attitude_unit);
    record_.setpoints_received.resize(static_cast<std::size_t>(ticks));
  }
}

void LiveUnit::run() {
  warm_ = thread_usage();
  if (on_estimate_) {
    run_on_estimates();
  } else {
    run_on_releases();
  }
  record_.usage = thread_usage() - warm_;
  const bool is_last = links_.flying.fetch_sub(1, std::memory_order_relaxed) == 1;
  if (is_last || record_.fault) links_.stop.store(true, std::memory_order_relaxed);
  record_.ticks.resize(ticks_);
  record_.samples.resize(std::min(ticks_, samples_max_));
}

void LiveUnit::run_on_releases() {
  for (std::int64_t k = 0; k < deadlines_ && !links_.stop.load(std::memory_order_relaxed);) {
    const Nanoseconds woke = clock_.wait_until(rate_.tick(k));
    take_sample();
    const Nanoseconds finish = tick({k, rate_.tick(k), rate_.tick(k + 1), woke});
    if (record_.fault) return;
    // If several releases have passed since, the last of them is used.
    const std::int64_t last_passed = rate_.ticks_in(finish + Nanoseconds(1)) - 1;
    const std::int64_t next = std::max(k + 1, std::min(last_passed, deadlines_));
    count_skipped(k, next);
    k = next;
  }
}

void LiveUnit::run_on_estimates() {
  constexpr auto look_for_the_end_every = std::chrono::milliseconds(10);
  std::int64_t last = -1;  // the last sample that was used
  while (last + 1 < deadlines_ && !links_.stop.load(std::memory_order_relaxed)) {
    // Read before the wait: if it is set and the wait then finds no sample, none will come.
    const bool is_over = links_.all_published.load(std::memory_order_acquire);
    const bool published = links_.published.try_acquire_for(look_for_the_end_every);
    const bool is_new = published && take_sample();
    const Nanoseconds woke = clock_.now();
    const std::int64_t sample = is_new ? rate_.ticks_in(latest_.time + Nanoseconds(1)) - 1 : last;
    if (sample > last && sample < deadlines_) {
      count_skipped(last, sample);
      last = sample;
      tick({sample, latest_.published, latest_.published + rate_.tick(1), woke});
      if (record_.fault) return;
      count_skipped(sample, sample + 1);
    } else if (is_over && !published) {
      count_skipped(last, deadlines_);
      return;
    }
  }
}

void LiveUnit::count_skipped(std::int64_t k, std::int64_t next) {
  const auto skipped = static_cast<std::uint32_t>(next - k - 1);
  if (ticks_ > 0) record_.ticks[ticks_ - 1].skipped += skipped;
  record_.skipped += skipped;
  if (ticks_ == 1) warm_ = thread_usage();
  passed_.store(static_cast<std::uint64_t>(next), std::memory_order_relaxed);
  missed_.store(late_ + record_.skipped, std::memory_order_relaxed);
}

Nanoseconds LiveUnit::tick(LiveTick due) {
  take_messages();
  // Read after the messages, so that no message is later than the tick.
  due.begins = clock_.now();
  due.sampled = sampled_ ? latest_.time : Nanoseconds(-1);
  task_.prepare(ticks_, due.begins, arrivals_at(due.begins));

  const std::int64_t yields_before = thread_yields();
  const Nanoseconds cpu_before = thread_cpu_time(), before = clock_.now();
  record_.fault = task_.step(ticks_);
  const Nanoseconds after = clock_.now(), cpu_after = thread_cpu_time();
  if (record_.fault) return after;
  if (const auto costs = task_.costs(); !costs.empty()) due.cost = costs.front().cost;
  send(after);
  due.finish = clock_.now();
  due.elapsed = after - before;
  due.cpu = cpu_after - cpu_before;
  due.waited = thread_yields() != yields_before;
  write_down(due);
  return due.finish;
}

Arrivals LiveUnit::arrivals_at(Nanoseconds now) {
  Arrivals arrivals;
  if (sampled_) arrivals.estimate = estimator_.sample(latest_.time, latest_.state);
  arrivals.landed = std::exchange(landed_, std::nullopt);
  if (!commands_motors_) return arrivals;
  arrivals.saturation = saturation_at(now);
  arrivals.battery_scale = battery_scales_.receive(now);
  if (const auto setpoint = rates_setpoints_.receive(now)) {
    arrivals.rates_setpoint = setpoint->value;
    record_.setpoints_received[setpoint->tick] = now;
  }
  return arrivals;
}

void LiveUnit::send(Nanoseconds made) {
  if (commands_motors_) {
    links_.commands.write({ticks_, made, task_.commands(), task_.throttle(), task_.is_armed()});
  } else if (const auto setpoint = rates_setpoint_of(task_.sample().attitude_out)) {
    links_.rates_setpoints.write({ticks_, made, *setpoint});
  }
}

bool LiveUnit::take_sample() {
  const LiveState* state = own_.states.read();
  if (state == nullptr) return false;
  latest_ = *state;
  return sampled_ = true;
}

// A buffer has one reader. So only the unit that commands the motors reads the buffers that are not
// in UnitLinks.
void LiveUnit::take_messages() {
  if (const LandDetected* landed = own_.landed.read()) landed_ = *landed;
  if (!commands_motors_) return;
  if (const LiveBattery* battery = links_.batteries.read()) {
    battery_scales_.send(battery->time, battery->scale);
  }
  if (const LiveRatesSetpoint* setpoint = links_.rates_setpoints.read()) {
    rates_setpoints_.send(setpoint->made, *setpoint);
  }
}

std::optional<Saturation> LiveUnit::saturation_at(Nanoseconds now) {
  const std::vector<Nanoseconds>& times = saturation_times_;
  for (; saturations_done_ < times.size() && times[saturations_done_] <= now; ++saturations_done_) {
    saturations_.send(times[saturations_done_], task_.saturation());
  }
  return saturations_.receive(now);
}

void LiveUnit::write_down(const LiveTick& tick) {
  late_ += tick.finish > tick.deadline ? 1 : 0;
  record_.ticks[ticks_] = tick;
  if (ticks_ < samples_max_) {
    record_.samples[ticks_] = task_.sample();
    record_.changes.insert(record_.changes.end(), task_.changes().begin(), task_.changes().end());
  }
  ++ticks_;
}

}  // namespace attest
