#include "harness/compare/metric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<std::pair<Measure, std::string_view>, 8> names = {{
    {Measure::settling_time_s, "settling_time_s"},
    {Measure::overshoot_deg, "overshoot_deg"},
    {Measure::rms_attitude_error_deg, "rms_attitude_error_deg"},
    {Measure::rms_rate_error_rad_s, "rms_rate_error_rad_s"},
    {Measure::peak_rate_rad_s, "peak_rate_rad_s"},
    {Measure::saturation_duty, "saturation_duty"},
    {Measure::peak_integral, "peak_integral"},
    {Measure::sink_m, "sink_m"},
}};

double square(double value) { return value * value; }

// As std::max, but a NaN in `b` stays: std::max would drop it.
double larger(double a, double b) { return std::isnan(b) || b > a ? b : a; }

// The angle between two attitudes, independent of the signs and norms of their quaternions. It uses
// atan2, because acos has no resolution where the angle is small.
double angle_deg(const std::array<float, 4>& q, const float (&q_d)[4]) {
  const auto at = [&](std::size_t i) { return static_cast<double>(q[i]); };
  const auto to = [&](std::size_t i) { return static_cast<double>(q_d[i]); };
  const double w = at(0) * to(0) + at(1) * to(1) + at(2) * to(2) + at(3) * to(3);
  const double x = at(0) * to(1) - at(1) * to(0) - at(2) * to(3) + at(3) * to(2);
  const double y = at(0) * to(2) - at(2) * to(0) - at(3) * to(1) + at(1) * to(3);
  const double z = at(0) * to(3) - at(3) * to(0) - at(1) * to(2) + at(2) * to(1);
  const double vector = std::sqrt(square(x) + square(y) + square(z));
  return 2 * std::atan2(vector, std::abs(w)) * 180 / std::numbers::pi;
}

// The rates setpoint is an input where neither attitude nor manual flight is enabled.
bool is_offboard_rates(const attest_inputs& in) {
  return in.vehicle_control_mode.flag_control_attitude_enabled == 0 &&
         in.vehicle_control_mode.flag_control_manual_enabled == 0;
}

double squared_rate_error(const Sample& sample, const PlantSample& plant) {
  const auto& own = sample.out.vehicle_rates_setpoint;
  const auto& outside = sample.in.vehicle_rates_setpoint;
  const bool offboard = is_offboard_rates(sample.in);
  const std::array<float, 3> wanted = {offboard ? outside.roll : own.roll,
                                       offboard ? outside.pitch : own.pitch,
                                       offboard ? outside.yaw : own.yaw};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += square(static_cast<double>(wanted[i]) - static_cast<double>(plant.rate_rad_s[i]));
  }
  return sum;
}

// A window of a flown trace.
class Flown {
 public:
  Flown(const Trace& trace, const Window& window) : trace_(trace), window_(window) {
    const std::size_t ticks = std::min(trace.samples.size(), trace.plant.size());
    while (end_ < ticks && seconds(end_) < window.to_s) ++end_;
    while (begin_ < end_ && seconds(begin_) < window.from_s) ++begin_;
  }

  bool empty() const { return begin_ == end_; }

  double settling_time_s(double band_deg) const {
    std::size_t settled = end_;  // first tick from which on the error stays within the band
    while (settled > begin_ && error_deg(settled - 1) <= band_deg) --settled;
    if (settled == end_) return infinity;
    return settled == begin_ ? 0 : seconds(settled) - window_.from_s;
  }

  double overshoot_deg(double band_deg) const {
    std::size_t tick = begin_;
    while (tick < end_ && error_deg(tick) > band_deg) ++tick;
    double largest = tick == end_ ? infinity : 0;
    for (; tick < end_; ++tick) largest = larger(largest, error_deg(tick));
    return largest;
  }

  double root_mean(const std::function<double(std::size_t)>& squared) const {
    return std::sqrt(mean(squared));
  }
  double mean(const std::function<double(std::size_t)>& value) const {
    double sum = 0;
    for (std::size_t tick = begin_; tick < end_; ++tick) sum += value(tick);
    return sum / static_cast<double>(end_ - begin_);
  }
  double peak(const std::function<double(std::size_t)>& value) const {
    double largest = 0;
    for (std::size_t tick = begin_; tick < end_; ++tick) largest = larger(largest, value(tick));
    return largest;
  }

  double sink_m() const {
    return static_cast<double>(trace_.plant[end_ - 1].position_m[2]) -
           static_cast<double>(trace_.plant[begin_].position_m[2]);
  }

  double error_deg(std::size_t tick) const {
    return angle_deg(trace_.plant[tick].q, trace_.samples[tick].in.vehicle_attitude_setpoint.q_d);
  }

 private:
  double seconds(std::size_t tick) const {
    // Divided, so that 28000 us give the same bits as the 0.028 s of a window.
    const auto since = trace_.samples[tick].in.timestamp - trace_.samples[0].in.timestamp;
    return static_cast<double>(since) / 1e6;
  }

  const Trace& trace_;
  Window window_;
  std::size_t begin_ = 0, end_ = 0;
};

double peak_rate(const Flown& flown, const Trace& trace) {
  return flown.peak([&](std::size_t tick) {
    double sum = 0;
    for (const float rate : trace.plant[tick].rate_rad_s) sum += square(static_cast<double>(rate));
    return std::sqrt(sum);
  });
}

double peak_integral(const Flown& flown, const Trace& trace) {
  return flown.peak([&](std::size_t tick) {
    const auto& status = trace.samples[tick].out.mc_att_ctrl_status;
    double largest = 0;
    for (const float integral :
         {status.roll_rate_integ, status.pitch_rate_integ, status.yaw_rate_integ}) {
      largest = larger(largest, std::abs(static_cast<double>(integral)));
    }
    return largest;
  });
}

double over(const Metric& metric, const Window& window, const Trace& trace) {
  const Flown flown(trace, window);
  if (flown.empty()) return nan;
  switch (metric.measure) {
    case Measure::settling_time_s:
      return flown.settling_time_s(metric.band_deg);
    case Measure::overshoot_deg:
      return flown.overshoot_deg(metric.band_deg);
    case Measure::rms_attitude_error_deg:
      return flown.root_mean([&](std::size_t tick) { return square(flown.error_deg(tick)); });
    case Measure::rms_rate_error_rad_s:
      return flown.root_mean([&](std::size_t tick) {
        return squared_rate_error(trace.samples[tick], trace.plant[tick]);
      });
    case Measure::peak_rate_rad_s:
      return peak_rate(flown, trace);
    case Measure::saturation_duty:
      return flown.mean([&](std::size_t tick) { return trace.plant[tick].saturated ? 1.0 : 0.0; });
    case Measure::peak_integral:
      return peak_integral(flown, trace);
    case Measure::sink_m:
      return flown.sink_m();
  }
  return nan;
}

}  // namespace

std::string_view name_of(Measure measure) {
  return names[static_cast<std::size_t>(measure)].second;
}

Result<Measure> parse_measure(std::string_view name) {
  std::vector<std::string> known;
  for (const auto& [measure, its_name] : names) {
    if (name == its_name) return measure;
    known.emplace_back(its_name);
  }
  return fail(fmt::format("unknown measure `{}`{}; there are {}", name, suggestion(name, known),
                          fmt::join(known, ", ")));
}

double measured(const Metric& metric, const Trace& flown) {
  const double value = over(metric, metric.window, flown);
  return metric.versus ? value / over(metric, *metric.versus, flown) : value;
}

}  // namespace attest
