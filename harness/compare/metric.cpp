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
constexpr float nanf = std::numeric_limits<float>::quiet_NaN();

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

// Same as std::max, except that a NaN in `b` is kept: std::max would drop it.
double larger(double a, double b) { return std::isnan(b) || b > a ? b : a; }

// The angle between two attitudes, independent of the signs and norms of their quaternions. It uses
// atan2, because acos has no resolution where the angle is small.
double angle_deg(const std::array<float, 4>& q, const std::array<float, 4>& q_d) {
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

template <typename Topic>
std::array<float, 3> rates_of(const Topic& topic) {
  return {topic.roll, topic.pitch, topic.yaw};
}

std::array<float, 3> wanted_rates(Module module, const Sample& sample) {
  if (module == Module::rate_unit) {
    const auto& mode = sample.rate_in.vehicle_control_mode;
    const bool acro =
        mode.flag_control_manual_enabled != 0 && mode.flag_control_attitude_enabled == 0;
    return acro ? rates_of(sample.rate_out.vehicle_rates_setpoint)
                : rates_of(sample.rate_in.vehicle_rates_setpoint);
  }
  return is_offboard_rates(sample.in) ? rates_of(sample.in.vehicle_rates_setpoint)
                                      : rates_of(sample.out.vehicle_rates_setpoint);
}

double squared_rate_error(Module module, const Sample& sample, const PlantSample& plant) {
  const std::array<float, 3> wanted = wanted_rates(module, sample);
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += square(static_cast<double>(wanted[i]) - static_cast<double>(plant.rate_rad_s[i]));
  }
  return sum;
}

// The setpoint that a step followed. In stabilized mode the attitude unit makes it from the sticks.
const float (&attitude_setpoint(const Sample& sample, bool is_attitude_unit))[4] {
  if (!is_attitude_unit) return sample.in.vehicle_attitude_setpoint.q_d;
  const attest_attitude_inputs& in = sample.attitude_in;
  const auto& mode = in.vehicle_control_mode;
  const bool follows_others = mode.flag_control_altitude_enabled != 0 ||
                              mode.flag_control_velocity_enabled != 0 ||
                              mode.flag_control_position_enabled != 0;
  const bool stabilized = mode.flag_control_manual_enabled != 0 &&
                          mode.flag_control_attitude_enabled != 0 && !follows_others;
  return stabilized ? sample.attitude_out.vehicle_attitude_setpoint.q_d
                    : in.vehicle_attitude_setpoint.q_d;
}

// A window of a flown trace.
class Flown {
 public:
  Flown(const Trace& trace, const Trace* attitude, const Window& window)
      : trace_(trace), errors_deg_(attitude_errors_deg(trace, attitude)), window_(window) {
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

  double error_deg(std::size_t tick) const { return errors_deg_[tick]; }

 private:
  double seconds(std::size_t tick) const {
    // Divided, so that 28000 us give the same bits as the 0.028 s of a window.
    const auto since = trace_.samples[tick].in.timestamp - trace_.samples[0].in.timestamp;
    return static_cast<double>(since) / 1e6;
  }

  const Trace& trace_;
  std::vector<double> errors_deg_;
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

std::array<float, 3> integrals_of(Module module, const Sample& sample) {
  if (module == Module::rate_unit) {
    const auto& status = sample.rate_out.rate_ctrl_status;
    return {status.rollspeed_integ, status.pitchspeed_integ, status.yawspeed_integ};
  }
  const auto& status = sample.out.mc_att_ctrl_status;
  return {status.roll_rate_integ, status.pitch_rate_integ, status.yaw_rate_integ};
}

double peak_integral(const Flown& flown, const Trace& trace) {
  const Module module = module_of(trace.present);
  return flown.peak([&](std::size_t tick) {
    double largest = 0;
    for (const float integral : integrals_of(module, trace.samples[tick])) {
      largest = larger(largest, std::abs(static_cast<double>(integral)));
    }
    return largest;
  });
}

double over(const Metric& metric, const Window& window, const Trace& trace, const Trace* attitude) {
  const Flown flown(trace, attitude, window);
  if (flown.empty() || (attitude != nullptr && attitude->samples.empty())) return nan;
  const Module module = module_of(trace.present);
  switch (metric.measure) {
    case Measure::settling_time_s:
      return flown.settling_time_s(metric.band_deg);
    case Measure::overshoot_deg:
      return flown.overshoot_deg(metric.band_deg);
    case Measure::rms_attitude_error_deg:
      return flown.root_mean([&](std::size_t tick) { return square(flown.error_deg(tick)); });
    case Measure::rms_rate_error_rad_s:
      return flown.root_mean([&](std::size_t tick) {
        return squared_rate_error(module, trace.samples[tick], trace.plant[tick]);
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

std::string_view unit_of(Measure measure) {
  for (const auto& [suffix, unit] : {std::pair("_rad_s", "rad/s"), std::pair("_s", "s"),
                                     std::pair("_deg", "deg"), std::pair("_m", "m")}) {
    if (name_of(measure).ends_with(suffix)) return unit;
  }
  return "";
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

std::vector<std::array<float, 4>> attitude_setpoints(const Trace& flown, const Trace* attitude) {
  std::vector<std::array<float, 4>> setpoints;
  setpoints.reserve(flown.samples.size());
  std::size_t next = 0;  // tick of the attitude unit
  for (const Sample& sample : flown.samples) {
    const Sample* of = &sample;
    if (attitude != nullptr) {
      const auto& samples = attitude->samples;
      while (next < samples.size() && samples[next].in.timestamp <= sample.in.timestamp) ++next;
      of = next > 0 ? &samples[next - 1] : samples.empty() ? nullptr : &samples.front();
    }
    setpoints.push_back(of ? std::to_array(attitude_setpoint(*of, attitude != nullptr))
                           : std::array{nanf, nanf, nanf, nanf});
  }
  return setpoints;
}

std::vector<double> attitude_errors_deg(const Trace& flown, const Trace* attitude) {
  const auto setpoints = attitude_setpoints(flown, attitude);
  std::vector<double> errors;
  for (std::size_t tick = 0; tick < std::min(setpoints.size(), flown.plant.size()); ++tick) {
    errors.push_back(angle_deg(flown.plant[tick].q, setpoints[tick]));
  }
  return errors;
}

double measured(const Metric& metric, const Trace& flown, const Trace* attitude) {
  const double value = over(metric, metric.window, flown, attitude);
  return metric.versus ? value / over(metric, *metric.versus, flown, attitude) : value;
}

}  // namespace attest
