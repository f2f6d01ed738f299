#include "harness/realtime/live_plant.hpp"

#include <algorithm>

namespace attest {

LivePlant::LivePlant(PlantTask& task, const Rate& physics, Nanoseconds duration, std::size_t ticks,
                     Clock& clock, Links& links)
    : task_(task), physics_(physics), duration_(duration), clock_(clock), links_(links) {
  record_.commanded.resize(ticks);
  record_.divergence = advance(Nanoseconds(0));
  links_.states.write({Nanoseconds(0), task_.state()});
}

void LivePlant::run() {
  const Usage begin = thread_usage();
  std::int64_t step = 1;
  while (!links_.stop.load(std::memory_order_relaxed) && physics_.tick(step) <= duration_) {
    const Nanoseconds due = physics_.tick(step);
    const Nanoseconds woke = clock_.wait_until(due);
    const std::int64_t last_due = physics_.ticks_in(woke + Nanoseconds(1)) - 1;
    const std::int64_t reached = std::max(step, last_due);
    record_.late_steps += static_cast<std::uint64_t>(reached - step);
    record_.steps += static_cast<std::uint64_t>(reached - step + 1);
    record_.lateness.add(woke - due);
    const Nanoseconds now = physics_.tick(reached);
    if ((record_.divergence = advance(now))) break;
    links_.states.write({now, task_.state()});
    if ((record_.divergence = take_commands(now))) break;
    step = reached + 1;
  }
  record_.usage = thread_usage() - begin;
  if (record_.divergence) links_.stop.store(true, std::memory_order_relaxed);
}

std::optional<Divergence> LivePlant::advance(Nanoseconds to) {
  const auto& times = task_.disturbance_times();
  for (; disturbed_ < times.size() && times[disturbed_] <= to; ++disturbed_) {
    if (auto lost = task_.advance(times[disturbed_])) return lost;
    if (auto lost = task_.disturb(times[disturbed_])) return lost;
  }
  return task_.advance(to);
}

// A step that was late may find a command that was made after its time, which it must not follow
// yet: what is recorded could not be flown again.
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
  return task_.command(now, command.commands);
}

}  // namespace attest
