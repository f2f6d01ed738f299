#include "harness/suite/time_batch.hpp"

#include <algorithm>
#include <utility>

#include "harness/casefile/stimulus.hpp"
#include "harness/core/float_environment.hpp"
#include "harness/process/child.hpp"
#include "harness/realtime/pacer.hpp"
#include "harness/run/open_loop.hpp"
#include "harness/suite/evaluate.hpp"
#include "harness/suite/judge.hpp"
#include "harness/trace/csv.hpp"

// Neither inlined nor given another name: counted_step_symbol.
extern "C" [[gnu::noinline]] int attest_counted_step(attest::Unit& unit, const attest_inputs& in,
                                                     attest_outputs& out) {
  return unit.step(in, out);
}

namespace attest {
namespace {

// A unit whose steps are timed.
class TimedUnit final : public Unit {
 public:
  TimedUnit(Unit& unit, Nanoseconds clock, std::vector<Nanoseconds>& times)
      : unit_(unit), clock_(clock), times_(times) {}

  int set_parameter(const std::string& name, float value) override {
    return unit_.set_parameter(name, value);
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    return unit_.set_timestamp_sample(timestamp_sample_us);
  }
  int step(const attest_inputs& in, attest_outputs& out) override {
    const Nanoseconds before = Pacer::now_monotonic();
    const int code = attest_counted_step(unit_, in, out);
    const Nanoseconds after = Pacer::now_monotonic();
    times_.push_back(std::max(after - before - clock_, Nanoseconds(0)));
    return code;
  }

 private:
  Unit& unit_;
  Nanoseconds clock_;
  std::vector<Nanoseconds>& times_;
};

// A unit whose steps run on a stack of their own.
class UnitOnStack final : public Unit {
 public:
  UnitOnStack(Unit& unit, PaintedStack& stack) : unit_(unit), stack_(stack) {}

  int set_parameter(const std::string& name, float value) override {
    return unit_.set_parameter(name, value);
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    return unit_.set_timestamp_sample(timestamp_sample_us);
  }
  int step(const attest_inputs& in, attest_outputs& out) override {
    int code = ATTEST_FAILED;
    stack_.run([&] { code = unit_.step(in, out); });
    return code;
  }

 private:
  Unit& unit_;
  PaintedStack& stack_;
};

// The least that lies between two readings.
Nanoseconds time_of_clock() {
  Nanoseconds least = Nanoseconds::max();
  for (int i = 0; i < 10'000; ++i) {
    const Nanoseconds before = Pacer::now_monotonic();
    least = std::min(least, Pacer::now_monotonic() - before);
  }
  return least;
}

double value_of(Nanoseconds time) { return static_cast<double>(time.count()); }

}  // namespace

TimeBatch::TimeBatch(std::vector<SelectedCase> cases, TimeOptions options)
    : cases_(std::move(cases)),
      options_(std::move(options)),
      times_(options_.budget_us ? Nanoseconds(static_cast<std::int64_t>(*options_.budget_us * 1000))
                                : Nanoseconds::max()) {
  for (const SelectedCase& selected : cases_) {
    for (const Setup& setup : selected.setups) vectors_.push_back({&selected.the_case, setup});
  }
}

CaseResult TimeBatch::identity(std::size_t i) const {
  if (i < vectors_.size()) return unjudged(*vectors_[i].the_case, vectors_[i].setup);
  CaseResult all;
  all.name = "all";
  return all;
}

Result<void> TimeBatch::open() {
  clock_ = time_of_clock();
  if (!options_.stack) return {};
  auto stack = PaintedStack::make();
  if (!stack) return tl::unexpected(stack.error());
  stack_.emplace(*std::move(stack));
  return {};
}

Result<CaseResult> TimeBatch::evaluate(std::size_t i, Port& port) {
  if (i == vectors_.size()) return all_together(port);
  CaseResult result = identity(i);
  std::vector<Nanoseconds> times = measure(vectors_[i], port, result);
  if (times.empty()) return result;
  if (stack_) {
    const auto used = measure_stack(vectors_[i], port, result);
    if (!used) return result;
    most_stack_ = std::max(most_stack_, *used);
    result.figures[figure::stack] = static_cast<double>(*used);
  }
  for (const Nanoseconds time : times) times_.add(time);
  const auto worst = std::max_element(times.begin(), times.end());
  const auto tick = static_cast<std::size_t>(worst - times.begin());
  if (!slowest_ || *worst > slowest_->time) slowest_ = Slowest{i, tick, *worst};
  result.ticks = times.size();
  result.figures[figure::steps] = static_cast<double>(times.size());
  result.figures[figure::max] = value_of(*worst);
  result.figures[figure::worst_tick] = static_cast<double>(tick);
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                   times.end());
  result.figures[figure::median] = value_of(times[times.size() / 2]);
  return result;
}

Trace TimeBatch::inputs_of(const Vector& vector) {
  const DefaultFloatEnvironment environment;
  return stimulate(*vector.the_case, vector.setup.rate);
}

std::vector<Nanoseconds> TimeBatch::measure(const Vector& vector, Port& port, CaseResult& result) {
  const Trace inputs = inputs_of(vector);
  std::vector<Nanoseconds> least, times;
  times.reserve(inputs.samples.size());
  for (int repeat = 0; repeat < options_.repeats; ++repeat) {
    begin_part();
    const auto unit = create_unit(port, vector.the_case->profile, result);
    if (!unit) return {};
    Trace trace = inputs;
    times.clear();
    TimedUnit timed(*unit, clock_, times);
    if (const auto fault = drive(timed, trace)) {
      judge(*fault, result);
      return {};
    }
    if (least.empty()) least = times;
    for (std::size_t i = 0; i < times.size(); ++i) least[i] = std::min(least[i], times[i]);
  }
  return least;
}

std::optional<std::size_t> TimeBatch::measure_stack(const Vector& vector, Port& port,
                                                    CaseResult& result) {
  Trace trace = inputs_of(vector);
  begin_part();
  const auto unit = create_unit(port, vector.the_case->profile, result);
  if (!unit) return std::nullopt;
  stack_->repaint();
  UnitOnStack on_stack(*unit, *stack_);
  if (const auto fault = drive(on_stack, trace)) {
    judge(*fault, result);
    return std::nullopt;
  }
  return stack_->used();
}

Result<CaseResult> TimeBatch::all_together(Port& port) {
  CaseResult all = identity(vectors_.size());
  all.figures = {{figure::steps, static_cast<double>(times_.count())},
                 {figure::min, value_of(times_.min())},
                 {figure::median, value_of(times_.percentile(0.5))},
                 {figure::p90, value_of(times_.percentile(0.9))},
                 {figure::p99, value_of(times_.percentile(0.99))},
                 {figure::p999, value_of(times_.percentile(0.999))},
                 {figure::max, value_of(times_.max())},
                 {figure::over_budget, static_cast<double>(times_.over_limit())},
                 {figure::clock, value_of(clock_)}};
  if (stack_) all.figures[figure::stack] = static_cast<double>(most_stack_);
  if (!slowest_) return all;
  const Vector& slowest = vectors_[slowest_->vector];
  all.reason = unjudged(*slowest.the_case, slowest.setup).id();
  all.figures[figure::worst_tick] = static_cast<double>(slowest_->tick);
  if (options_.worst.empty()) return all;
  if (auto written = write_worst(port); !written) return tl::unexpected(written.error());
  return all;
}

// Up to the slowest step, with what the port answers: for `attest replay`.
Result<void> TimeBatch::write_worst(Port& port) const {
  const Vector& slowest = vectors_[slowest_->vector];
  Trace trace = stimulate(*slowest.the_case, slowest.setup.rate);
  trace.samples.resize(slowest_->tick + 1);
  std::erase_if(trace.parameters,
                [&](const ParameterChange& change) { return change.tick > slowest_->tick; });
  const auto unit = port.create(slowest.the_case->profile);
  if (const auto fault = drive(*unit, trace)) return fail(fault->what);
  const DefaultFloatEnvironment environment;
  trace.present = channels_of(Part::mc_att_control);
  allow_large_files();
  auto file = AtomicFile::open(options_.worst);
  if (!file) return tl::unexpected(file.error());
  if (auto written = write_csv(trace, all_columns(trace), *file); !written) return written;
  return file->commit();
}

}  // namespace attest
