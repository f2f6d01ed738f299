#include "harness/measure/rate_sweep.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/core/json_reader.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/judge.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

// If a vehicle misses a bound at the highest rate, the bounds of the case are wrong. At the lowest
// rate the period is far beyond 20 ms, to which the law limits its time step.
constexpr int highest_hz = 1000, lowest_hz = 2;
constexpr double rate_step = 0.8;
// In units of 0.1 ms. No multicopter is flown with a delay beyond half a second.
constexpr int longest_delay = 5000, delay_step = 20;

class Trial {
 public:
  Trial(const Case& the_case, PortHost& host, VectorResult& result)
      : case_(the_case), host_(host), result_(result) {}

  bool holds(const RunConfiguration& configuration, Nanoseconds delay) {
    if (result_.verdict != Verdict::pass || error_) return false;
    FlightPlan plan = FlightPlan::as_scheduled(case_, configuration);
    const Declarations& port = host_.declarations();
    if (has_other_steps(port, case_, configuration.rate.motor_unit, plan.timing, result_))
      return false;
    if (marks_declined(port, result_)) return false;
    for (LoopTick& tick : plan.timing.unit) *tick.commanded += delay;
    plan.from_one_period_on = has_fixed_step(port, case_);
    const auto flown = host_.fly(plan);
    if (!flown) {
      error_ = flown.error();
    } else if (flown->fault) {
      judge(*flown->fault, result_);
    } else {
      return note(configuration.rate.motor_unit, delay, *flown);
    }
    return false;
  }

  std::vector<RateSweepTrial> take_trials() { return std::move(trials_); }

  const std::optional<Error>& error() const { return error_; }

 private:
  bool note(const Rate& rate, Nanoseconds delay, const Flown& flown) {
    RateSweepTrial trial{rate.hertz(), 1e3 * in_seconds(delay), {}, !flown.divergence};
    if (!flown.divergence) {
      for (const Metric& metric : case_.flight->metrics) {
        const double value = measured(metric, flown);
        trial.holds = trial.holds && value >= metric.min && value <= metric.max;
        trial.values.push_back(value);
      }
    }
    trials_.push_back(std::move(trial));
    return trials_.back().holds;
  }

  const Case& case_;
  PortHost& host_;
  VectorResult& result_;
  std::vector<RateSweepTrial> trials_;
  std::optional<Error> error_;
};

// The last number from `good` on that holds. REQUIRES: `good` holds and `bad` does not.
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

// `usual` with another rate of the unit that commands the motors. The rate of the attitude unit is
// not above it.
LoopRate with_unit_at(const Rate& unit, const LoopRate& usual) {
  if (!usual.attitude_unit) return unit;
  return {std::min(*usual.attitude_unit, unit), unit};
}

}  // namespace

std::string Codec<RateSweepResult>::encode(const Result<RateSweepResult>& result) {
  return attest::encode(result.map([](const RateSweepResult& one) {
    nlohmann::json out = {{"result", to_json(one.result)}};
    if (one.lowest_rate_hz) out["lowest_rate_hz"] = *one.lowest_rate_hz;
    if (one.largest_delay_ms) out["largest_delay_ms"] = *one.largest_delay_ms;
    out["trials"] = nlohmann::json::array();
    for (const auto& [rate_hz, delay_ms, values, holds] : one.trials) {
      nlohmann::json numbers = nlohmann::json::array();
      for (const double value : values) numbers.push_back(json_of(value));
      out["trials"].push_back({rate_hz, delay_ms, std::move(numbers), holds});
    }
    return out;
  }));
}

Result<RateSweepResult> Codec<RateSweepResult>::decode(const std::string& text) {
  const auto in = attest::decode(text);
  if (!in) return tl::unexpected(in.error());
  const auto figure = [&](const char* name) {
    return in->contains(name) ? std::optional(in->at(name).get<double>()) : std::nullopt;
  };
  std::vector<RateSweepTrial> trials;
  for (const nlohmann::json& trial : in->at("trials")) {
    trials.push_back({trial[0].get<double>(), trial[1].get<double>(), {}, trial[3].get<bool>()});
    for (const nlohmann::json& value : trial[2]) {
      trials.back().values.push_back(real_from(value).value());
    }
  }
  return vector_result_from_json(in->at("result")).map([&](VectorResult result) {
    return RateSweepResult{std::move(result), figure("lowest_rate_hz"), figure("largest_delay_ms"),
                           std::move(trials)};
  });
}

Result<void> RateSweepJob::open() {
  auto host = start_host(options_, {&case_, vehicle_model_.get()});
  if (!host) return tl::unexpected(host.error());
  host_ = *std::move(host);
  return {};
}

Result<RateSweepResult> RateSweepJob::run(std::size_t task) {
  const RunConfiguration configuration{rates_[task == 0 ? 0 : task - 1], plant_configuration_};
  RateSweepResult found{result_for(case_, configuration), {}, {}};
  Trial trial(case_, *host_, found.result);
  if (task == 0) {
    found.lowest_rate_hz = lowest_rate([&](int hertz) {
      return trial.holds({with_unit_at(Rate::hz(hertz), rates_.front()), plant_configuration_},
                         Nanoseconds(0));
    });
  } else {
    found.largest_delay_ms =
        0.1 * largest_delay([&](int delay) {
          return trial.holds(configuration, delay * std::chrono::microseconds(100));
        });
  }
  if (trial.error()) return tl::unexpected(*trial.error());
  found.trials = trial.take_trials();
  // Flights before the port's failure do not make a valid figure.
  if (found.result.verdict != Verdict::pass) {
    (task == 0 ? found.lowest_rate_hz : found.largest_delay_ms) = -1;
  }
  return found;
}

}  // namespace attest
