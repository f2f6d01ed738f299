#include "harness/suite/sweep.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "harness/core/float_environment.hpp"
#include "harness/run/case_timing.hpp"
#include "harness/run/flight.hpp"
#include "harness/suite/evaluate.hpp"
#include "harness/suite/fixed_step.hpp"
#include "harness/suite/judge.hpp"

namespace attest {
namespace {

// Above, every vehicle of a case holds, or its bounds are wrong; below, the law's own clamp of the
// time step (20 ms) has long been passed.
constexpr int highest_hz = 1000, lowest_hz = 2;
constexpr double rate_step = 0.8;
// In units of 0.1 ms: beyond half a second no multicopter is flown.
constexpr int longest_delay = 5000, delay_step = 20;

// Flies a case again and again, each time in another way.
class Trial {
 public:
  // Calls `begins` before each flight.
  Trial(const Case& the_case, const Airframe& airframe, Port& port, CaseResult& result,
        std::function<void()> begins)
      : case_(the_case),
        airframe_(airframe),
        port_(port),
        result_(result),
        begins_(std::move(begins)) {}

  bool holds(const Setup& setup, Nanoseconds delay) {
    if (result_.verdict != Verdict::pass || error_) return false;
    begins_();
    LoopTiming timing = case_timing(case_, setup.rate);
    if (has_other_steps(port_, case_, setup.rate, timing, result_)) return false;
    const auto unit = create_unit(port_, case_.profile, result_);
    if (!unit) return false;
    for (LoopTick& tick : timing) *tick.commanded += delay;
    const Case& flies = has_fixed_step(port_, case_) ? from_one_period_on(case_) : case_;
    const auto flown = fly(flies, setup, airframe_, *unit, std::move(timing));
    if (!flown) {
      error_ = flown.error();
    } else if (flown->fault) {
      judge(*flown->fault, result_);
    } else {
      return !flown->divergence && within_bounds(flown->trace);
    }
    return false;
  }

  const std::optional<Error>& error() const { return error_; }

 private:
  bool within_bounds(const Trace& trace) const {
    const DefaultFloatEnvironment environment;
    const auto& metrics = case_.flight->metrics;
    return std::all_of(metrics.begin(), metrics.end(), [&](const Metric& metric) {
      const double value = measured(metric, trace);
      return value >= metric.min && value <= metric.max;
    });
  }

  const Case& case_;
  const Airframe& airframe_;
  Port& port_;
  CaseResult& result_;
  std::function<void()> begins_;
  std::optional<Error> error_;
};

// The last number from `good` towards `bad` that holds, given that `good` does and `bad` does not.
template <typename Holds>
int last_that_holds(int good, int bad, Holds&& holds) {
  while (std::abs(good - bad) > 1) {
    const int middle = (good + bad) / 2;
    (holds(middle) ? good : bad) = middle;
  }
  return good;
}

template <typename Holds>
double lowest_rate(Holds&& holds) {
  if (!holds(highest_hz)) return -1;
  int good = highest_hz;
  while (good > lowest_hz) {
    const int next = std::max(lowest_hz, static_cast<int>(good * rate_step));
    if (!holds(next)) return last_that_holds(good, next, holds);
    good = next;
  }
  return good;
}

template <typename Holds>
double largest_delay(Holds&& holds) {
  if (!holds(0)) return -1;
  int good = 0;
  while (good < longest_delay) {
    const int next = good + delay_step;
    if (!holds(next)) return last_that_holds(good, next, holds);
    good = next;
  }
  return good;
}

}  // namespace

CaseResult SweepBatch::identity(std::size_t i) const {
  return unjudged(case_, {rates_[i == 0 ? 0 : i - 1], flyer_});
}

std::size_t SweepBatch::most_parts() const {
  constexpr int halvings = 8;
  return longest_delay / delay_step + 1 + halvings;
}

Result<CaseResult> SweepBatch::evaluate(std::size_t i, Port& port) {
  CaseResult result = identity(i);
  Trial trial(case_, *airframe_, port, result, [this] { begin_part(); });
  if (i == 0) {
    result.figures[lowest_rate_figure] = lowest_rate([&](int hertz) {
      return trial.holds({Rate::hz(hertz), flyer_}, Nanoseconds(0));
    });
  } else {
    const Setup setup{rates_[i - 1], flyer_};
    result.figures[largest_delay_figure] =
        0.1 * largest_delay([&](int delay) {
          return trial.holds(setup, delay * std::chrono::microseconds(100));
        });
  }
  if (trial.error()) return tl::unexpected(*trial.error());
  return result;
}

}  // namespace attest
