#include "harness/host/port_calls.hpp"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <sys/mman.h>

namespace attest {

namespace {

enum class Call : std::uint32_t {
  none,
  create,
  set_parameter,
  set_timestamp_sample,
  step,
  batch,
  destroy
};

}  // namespace

struct RunningCall {
  std::atomic<Call> call{Call::none};
  std::atomic<std::uint64_t> tick{0};  // of the unit whose step() runs, from 0
};

struct PortCalls::Now {
  // In a live flight of the cascade, the attitude unit has a thread of its own.
  RunningCall running, of_attitude_unit;
  std::atomic<std::uint64_t> count{0};
  // Of a live flight. The progress may be read between two of its numbers: it is only shown.
  std::atomic<std::int64_t> time_ns{0};
  std::atomic<std::uint64_t> deadlines{0}, missed{0};
  std::atomic<bool> stop{false};

  RunningCall& of(Module module) {
    return module == Module::attitude_unit ? of_attitude_unit : running;
  }
};
// Two processes share these, so they must not contain a lock.
static_assert(std::atomic<Call>::is_always_lock_free);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
static_assert(std::atomic<bool>::is_always_lock_free);

namespace {

using Now = PortCalls::Now;

class Noted {
 public:
  Noted(Now& now, Module module, Call call) : running_(now.of(module)) {
    running_.call.store(call, std::memory_order_relaxed);
    now.count.fetch_add(1, std::memory_order_relaxed);
  }
  ~Noted() { running_.call.store(Call::none, std::memory_order_relaxed); }
  Noted(const Noted&) = delete;
  Noted& operator=(const Noted&) = delete;

 private:
  RunningCall& running_;
};

// " in step() at tick 17"; empty if no call runs.
std::string text_of(const RunningCall& running) {
  const std::uint64_t tick = running.tick.load(std::memory_order_relaxed);
  switch (running.call.load(std::memory_order_relaxed)) {
    case Call::create:
      return " in create()";
    case Call::set_parameter:
      return " in set_parameter()";
    case Call::set_timestamp_sample:
      return " in set_timestamp_sample()";
    case Call::step:
      return fmt::format(" in step() at tick {}", tick);
    case Call::batch:
      return fmt::format(" in the batch of steps from tick {} on", tick);
    case Call::destroy:
      return " in destroy()";
    case Call::none:
      break;
  }
  return "";
}

class NotedUnit final : public Unit {
 public:
  NotedUnit(std::unique_ptr<Unit> unit, Module module, Now& now)
      : unit_(std::move(unit)), module_(module), now_(now) {}
  ~NotedUnit() override {
    const Noted noted(now_, module_, Call::destroy);
    unit_.reset();
  }

  int set_parameter(const std::string& name, float value) override {
    const Noted noted(now_, module_, Call::set_parameter);
    return unit_->set_parameter(name, value);
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    const Noted noted(now_, module_, Call::set_timestamp_sample);
    return unit_->set_timestamp_sample(timestamp_sample_us);
  }
  int step_structs(const void* in, void* out) override {
    now_.of(module_).tick.store(tick_++, std::memory_order_relaxed);
    const Noted noted(now_, module_, Call::step);
    return unit_->step_structs(in, out);
  }
  std::size_t max_batch() const override { return unit_->max_batch(); }
  Batched batch(std::span<Sample> samples,
                std::span<const std::uint64_t> timestamp_samples_us) override {
    now_.of(module_).tick.store(tick_, std::memory_order_relaxed);
    tick_ += samples.size();
    const Noted noted(now_, module_, Call::batch);
    return unit_->batch(samples, timestamp_samples_us);
  }
  std::span<const StepCost> costs() const override { return unit_->costs(); }

 private:
  std::unique_ptr<Unit> unit_;
  Module module_;
  Now& now_;
  std::uint64_t tick_ = 0;
};

class NotedPort final : public Port {
 public:
  NotedPort(Port& port, Now& now) : port_(port), now_(now) {}

  std::string name() const override { return port_.name(); }
  std::string version() const override { return port_.version(); }
  std::vector<std::string> unsupported_groups() const override {
    return port_.unsupported_groups();
  }
  const Lacks& lacks() const override { return port_.lacks(); }
  std::optional<int> fraction_bits() const override { return port_.fraction_bits(); }
  std::optional<Rate> fixed_step() const override { return port_.fixed_step(); }
  bool is_one_at_a_time() const override { return port_.is_one_at_a_time(); }
  ModuleSet modules() const override { return port_.modules(); }
  std::optional<CostCounter> cost() const override { return port_.cost(); }
  std::unique_ptr<Unit> create_unit(Module module, const std::string& profile,
                                    const std::string& definition) override {
    const Noted noted(now_, module, Call::create);
    auto unit = port_.create_unit(module, profile, definition);
    return unit ? std::make_unique<NotedUnit>(std::move(unit), module, now_) : nullptr;
  }

 private:
  Port& port_;
  Now& now_;
};

}  // namespace

Result<PortCalls> PortCalls::make() {
  void* const memory =
      ::mmap(nullptr, sizeof(Now), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    return fail(
        fmt::format("cannot share memory with the port's process: {}", std::strerror(errno)));
  }
  return PortCalls(new (memory) Now);
}

void PortCalls::reset() const { new (now_.get()) Now; }

void PortCalls::Unmap::operator()(Now* now) const { ::munmap(now, sizeof(Now)); }

std::string PortCalls::current() const {
  const std::string one = text_of(now_->running), attitude = text_of(now_->of_attitude_unit);
  if (attitude.empty()) return one;
  const std::string of_attitude =
      fmt::format("{} of the {}", attitude, info_of(Module::attitude_unit).title);
  return one.empty() ? of_attitude : one + " or" + of_attitude;
}

std::uint64_t PortCalls::count() const { return now_->count.load(std::memory_order_relaxed); }

void PortCalls::begin_flight() const {
  now_->time_ns = 0;
  now_->stop = false;
}

void PortCalls::ask_to_stop() const { now_->stop = true; }

LiveProgress PortCalls::progress() const {
  return {Nanoseconds(now_->time_ns), now_->deadlines, now_->missed};
}

LiveWatch PortCalls::watch() const {
  const auto publish = [this](const LiveProgress& progress) {
    now_->deadlines = progress.deadlines;
    now_->missed = progress.missed;
    now_->time_ns = progress.time.count();
  };
  return {[this] { return now_->stop.load(); }, publish};
}

std::unique_ptr<Port> PortCalls::noted(Port& port) const {
  return std::make_unique<NotedPort>(port, *now_);
}

std::unique_ptr<Unit> PortCalls::noted(std::unique_ptr<Unit> unit) const {
  return std::make_unique<NotedUnit>(std::move(unit), Module::mc_att_control, *now_);
}

}  // namespace attest
