#include "harness/casefile/signal.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "harness/core/random.hpp"

namespace attest {
namespace {

constexpr double ns_per_s = 1e9;
constexpr double radians = std::numbers::pi / 180;
constexpr double turn = 2 * std::numbers::pi;

double seconds(Nanoseconds time) { return static_cast<double>(time.count()) / ns_per_s; }

// Reflects `value` at the bounds. REQUIRES: min < max.
double reflect(double value, double min, double max) {
  if (value > max) value = 2 * max - value;
  if (value < min) value = 2 * min - value;
  return std::clamp(value, min, max);
}

std::vector<double> walk(const RandomWalk& walk, const Timeline& timeline) {
  const auto every = std::max<std::int64_t>(walk.every.on(timeline.rate).count(), 1);
  const auto steps = timeline.duration.count() / every;
  Random random(walk.seed);
  std::vector<double> values{walk.start};
  for (std::int64_t i = 0; i < steps; ++i) {
    const double moved = values.back() + random.uniform(-walk.step, walk.step);
    values.push_back(reflect(moved, walk.min, walk.max));
  }
  return values;
}

struct SampleAt {
  Nanoseconds time;
  const Timeline& timeline;
  const std::vector<double>& walked;
  const std::vector<Nanoseconds>& times;

  double operator()(const Constant& signal) const { return signal.value; }

  double operator()(const Step& signal) const {
    return time < signal.at.on(timeline.rate) ? signal.from : signal.to;
  }

  double operator()(const Ramp& signal) const {
    const Nanoseconds start = signal.start.on(timeline.rate);
    const Nanoseconds end = signal.end.on(timeline.rate);
    if (time <= start) return signal.from;
    if (time >= end) return signal.to;
    return signal.from + (signal.to - signal.from) * (seconds(time - start) / seconds(end - start));
  }

  double operator()(const Sine& signal) const {
    const double cycles = signal.frequency.hertz_on(timeline) * seconds(time);
    return signal.mean + signal.amplitude * std::sin(turn * cycles + signal.phase_deg * radians);
  }

  double operator()(const Chirp& signal) const {
    const double from = signal.from.hertz_on(timeline);
    const double to = signal.to.hertz_on(timeline);
    const double t = seconds(time);
    const double cycles = from * t + (to - from) * t * t / (2 * seconds(timeline.duration));
    return signal.mean + signal.amplitude * std::sin(turn * cycles);
  }

  double operator()(const RandomWalk& signal) const {
    const auto every = std::max<std::int64_t>(signal.every.on(timeline.rate).count(), 1);
    const auto index = static_cast<std::size_t>(time.count() / every);
    return walked[std::min(index, walked.size() - 1)];
  }

  double operator()(const Samples& signal) const {
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - times.begin() - 1, 0));
    const Nanoseconds begin = times[i];
    if (!signal.linear || i + 1 == times.size() || time <= begin) return signal.values[i];
    const double part = seconds(time - begin) / seconds(times[i + 1] - begin);
    return signal.values[i] + (signal.values[i + 1] - signal.values[i]) * part;
  }
};

Quaternion from_tilt(double tilt_deg, double azimuth_deg, double yaw_deg) {
  const double half_tilt = tilt_deg * radians / 2;
  const double half_yaw = yaw_deg * radians / 2;
  const double azimuth = azimuth_deg * radians;
  const double c = std::cos(half_tilt);
  const double x = std::sin(half_tilt) * std::cos(azimuth);
  const double y = std::sin(half_tilt) * std::sin(azimuth);
  const double cy = std::cos(half_yaw);
  const double sy = std::sin(half_yaw);
  // (c, x, y, 0) * (cy, 0, 0, sy)
  return {c * cy, x * cy + y * sy, y * cy - x * sy, c * sy};
}

Quaternion from_euler(double roll_deg, double pitch_deg, double yaw_deg) {
  const double cr = std::cos(roll_deg * radians / 2), sr = std::sin(roll_deg * radians / 2);
  const double cp = std::cos(pitch_deg * radians / 2), sp = std::sin(pitch_deg * radians / 2);
  const double cy = std::cos(yaw_deg * radians / 2), sy = std::sin(yaw_deg * radians / 2);
  // (cy, 0, 0, sy) * (cp, 0, sp, 0) * (cr, sr, 0, 0)
  return {cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr,
          sy * cp * cr - cy * sp * sr};
}

}  // namespace

Nanoseconds Span::on(const Rate& unit_rate) const {
  if (in == In::seconds) return Nanoseconds(std::llround(amount * ns_per_s));
  const double whole = std::floor(amount);
  const Nanoseconds tick = unit_rate.tick(static_cast<std::int64_t>(whole));
  const double rest = (amount - whole) * unit_rate.period_s();
  return tick + Nanoseconds(std::llround(rest * ns_per_s));
}

std::int64_t tick_count(const Span& duration, const Rate& unit_rate) {
  return duration.in == Span::In::ticks ? static_cast<std::int64_t>(duration.amount)
                                        : unit_rate.ticks_in(duration.on(unit_rate));
}

double Frequency::hertz_on(const Timeline& timeline) const {
  return in == In::hertz ? amount : amount / seconds(timeline.duration);
}

Sampler::Sampler(const Signal& signal, const Timeline& timeline)
    : signal_(signal), timeline_(timeline) {
  if (const auto* random = std::get_if<RandomWalk>(&signal_)) walk_ = walk(*random, timeline_);
  if (const auto* samples = std::get_if<Samples>(&signal_)) {
    times_.reserve(samples->times.size());
    for (const Span& span : samples->times) times_.push_back(span.on(timeline_.rate));
  }
}

double Sampler::at(Nanoseconds time) const {
  return std::visit(SampleAt{time, timeline_, walk_, times_}, signal_);
}

bool varies(const Signal& signal) { return !std::holds_alternative<Constant>(signal); }

Quaternion attitude_from(Angles by, const std::array<double, 3>& angles_deg) {
  const auto& [first, second, yaw] = angles_deg;
  return by == Angles::tilt_azimuth_yaw ? from_tilt(first, second, yaw)
                                        : from_euler(first, second, yaw);
}

}  // namespace attest
