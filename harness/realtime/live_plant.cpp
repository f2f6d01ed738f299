#include "harness/realtime/live_plant.hpp"

#include <algorithm>
#include <utility>

namespace attest {
namespace {

Nanoseconds next_of(const std::vector<Nanoseconds>& times, std::size_t done) {
  return done < times.size() ? times[done] : Nanoseconds::max();
}

}  // namespace

LivePlant::LivePlant(PlantTask& task, LivePlantPlan plan, Clock& clock, Links& links)
    : task_(task), plan_(std::move(plan)), clock_(clock), links_(links) {
  record_.commanded.resize(plan_.ticks);
  record_.divergence = advance(Nanoseconds(0));
  write_state(Nanoseconds(0), Nanoseconds(0));
}

void LivePlant::run() {
  const Usage begin = thread_usage();
  std::int64_t step = 1;
  if (plan_.estimator) {
    clock_.wait_until(Nanoseconds(0));
    publish(Nanoseconds(0));
  }
  while (!links_.stop.load(std::memory_order_relaxed) &&
         plan_.physics.tick(step) <= plan_.duration) {
    const Nanoseconds due = plan_.physics.tick(step);
    const Nanoseconds woke = clock_.wait_until(due);
    const std::int64_t last_due = plan_.physics.ticks_in(woke + Nanoseconds(1)) - 1;
    const std::int64_t reached = std::max(step, last_due);
    record_.late_steps += static_cast<std::uint64_t>(reached - step);
    record_.latency.add(woke - due);
    const Nanoseconds now = plan_.physics.tick(reached);
    if ((record_.divergence = advance(now))) break;
    publish(now);
    if ((record_.divergence = take_commands(now))) break;
    step = reached + 1;
  }
  record_.usage = thread_usage() - begin;
  links_.all_published.store(true, std::memory_order_release);
  links_.published.release();
  if (record_.divergence) links_.stop.store(true, std::memory_order_relaxed);
}

// Writes the state. If it is a new sample of the estimator, wakes the unit that waits for samples.
// Several samples that are due together wake it once.
void LivePlant::publish(Nanoseconds now) {
  write_state(now, clock_.now());
  if (!plan_.estimator) return;
  const std::int64_t due = plan_.estimator->ticks_in(now + Nanoseconds(1));
  if (due == estimates_) return;
  estimates_ = due;
  links_.published.release();
}

// Without an attitude unit, its buffer is written and never read.
void LivePlant::write_state(Nanoseconds now, Nanoseconds published) {
  links_.unit.states.write({now, task_.state(), published});
  links_.attitude_unit.states.write({now, task_.state(), published});
}

std::optional<Divergence> LivePlant::advance(Nanoseconds to) {
  const auto& disturbances = task_.disturbance_times();
  while (true) {
    const Nanoseconds disturbance = next_of(disturbances, disturbed_);
    const Nanoseconds battery = next_of(plan_.battery_times, batteries_);
    const Nanoseconds landing = next_of(plan_.landing_times, landings_);
    const Nanoseconds next = std::min({disturbance, battery, landing});
    if (next > to) break;
    if (auto lost = task_.advance(next)) return lost;
    // Events at the same instant happen in the order of closed_loop.hpp.
    if (disturbance == next) {
      ++disturbed_;
      if (auto lost = task_.disturb(next)) return lost;
    }
    if (battery == next) sample_battery(next);
    if (landing == next) detect_landing(next);
  }
  return task_.advance(to);
}

void LivePlant::sample_battery(Nanoseconds now) {
  ++batteries_;
  links_.batteries.write({now, task_.battery_scale(now, throttle_, armed_)});
}

void LivePlant::detect_landing(Nanoseconds now) {
  ++landings_;
  const LandDetected landed = plan_.land_detector->sample(now, task_.state(), throttle_, armed_);
  links_.unit.landed.write(landed);
  links_.attitude_unit.landed.write(landed);
}

// A late step may find a command that was made after its time. It must not follow this command yet,
// because a flight with such times could not be repeated in simulation.
std::optional<Divergence> LivePlant::take_commands(Nanoseconds now) {
  std::optional<Divergence> lost;
  if (pending_ && pending_->made <= now) {
    lost = command(now, *pending_);
    pending_.reset();
  }
  const LiveCommand* newest = links_.commands.read();
  if (lost || !newest) return lost;
  if (newest->made <= now) return command(now, *newest);
  pending_ = *newest;
  return std::nullopt;
}

std::optional<Divergence> LivePlant::command(Nanoseconds now, const LiveCommand& command) {
  record_.commanded[command.tick] = now;
  throttle_ = command.throttle;
  armed_ = command.armed;
  return task_.command(now, command.commands);
}

}  // namespace attest
