#include "harness/diagnosis/hunt_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace attest {
namespace {

constexpr double pi = std::numbers::pi;

// Thresholds of the law, and the largest value of other samples on both sides of 0 or, if `least`
// is given, from there on. LAW.md and LAW-CASCADE.md of the profiles have the thresholds.
struct HuntRow {
  std::string_view field;  // of the channel, without an index; or its quantity's, if empty
  Quantity quantity;
  double least, most;
  std::array<double, 6> special;  // repeated if there are fewer
};

constexpr HuntRow hunt_rows[] = {
    {"throttle", Quantity::stick, -1, 1, {-1, -0.9, 0, 1, -0.5, 0.5}},
    {"z", Quantity::stick, 0, 1, {0, 0.2, 0.9, 1, 0.5, 0.8}},
    {"", Quantity::stick, -1.1, 1.1, {-1, 0, 1, 0.1, -0.1, 0.05}},
    {"thrust_body", Quantity::thrust, -1, 0.1, {-1, -0.5, 0, -0.2, -0.9, -0.8}},
    {"thrust", Quantity::thrust, 0, 1.1, {0, 0.2, 0.5, 1, 0.9, 0.3}},
    {"hover_thrust", Quantity::thrust, -0.1, 1, {0, 0.05, 0.9, 0.1, 0.5, 1}},
    {"tpa_break", Quantity::thrust, 0, 1, {0, 1, 0.5, 0.3, 0.8, 0.2}},
    {"", Quantity::thrust, -0.1, 1.1, {0, 0.5, 1, 0.2, 0.9, 0.1}},
    {"rate_max", Quantity::rate, 0, 8, {0, 3.84, 3.49, 0.5, 1, 30}},
    {"ref_w_n", Quantity::rate, 1, 200, {50, 1, 10, 100, 200, 25}},
    {"ref_ff_max", Quantity::rate, 0, 10, {0, 1.75, 0.5, 3, 31, 1}},
    {"unallocated_torque", Quantity::control, -0.5, 0.5, {0, 1e-3, -1e-3, 2e-7, -2e-7, 0.1}},
    {"landing_gear", Quantity::control, -1, 1, {-1, 0, 1, 0.5, -0.5, 0.1}},
    {"", Quantity::rate, -4, 4, {0, 3.84, -3.84, 0.01, 6.9813, -7.2}},
    {"", Quantity::angular_acceleration, -60, 60, {0, 1, -1, 20, -20, 100}},
    {"unaided_heading", Quantity::angle, -3.2, 3.2, {0, 3.1, -3.1, 20, 0.0174, -9.5}},
    {"", Quantity::angle, -3.2, 3.2, {0, 3.1, -3.1, 1.57, -1.57, 0.1}},
    {"", Quantity::control, -1.2, 1.2, {0, 1, -1, 0.5, -0.5, 0.1}},
    {"integral_max", Quantity::integral, 0, 0.5, {0.3, 0, 0.05, 0.3, 1, 0.3}},
    {"", Quantity::integral, -0.5, 0.5, {0.3, 0, 0.05, -0.3, 0.1, -0.1}},
    {"yaw_weight", Quantity::scale, 0, 1, {0, 0.4, 1, 0.001, 0.1, 0.9}},
    {"p", Quantity::scale, 0, 0, {1, 1, 1, 1, 1, 1}},  // of the gains: see gain_of()
    {"scale", Quantity::scale, 0.7, 1.4, {1, 0, -1, 1.3, 0.5, 2}},
    {"", Quantity::scale, 0, 1, {0, 1, 0.5, 0.1, 0.15, 0.4}},
    {"dt", Quantity::duration, 0.0001, 0.025, {0.004, 0.000125, 0.02, 0.002, 0.0002, 0.001}},
    {"", Quantity::motor, 0, 0.5, {0, 0, 0.05, 0.01, 1, 0.2}},
    {"", Quantity::voltage, 5, 13.5, {12.15, 10.2, 12.6, 9, 2.1, 7}},
    {"", Quantity::current, -1, 60, {0, 10, 30, 60, -1, 1}},
};

bool is_indexed(std::string_view field, std::string_view name) {
  return field.substr(0, field.find('[')) == name;
}

const HuntRow& values_of(const Channel& channel) {
  const auto* const found = std::ranges::find_if(hunt_rows, [&](const HuntRow& values) {
    return values.quantity == channel.quantity &&
           (values.field.empty() || is_indexed(channel.field(), values.field));
  });
  return found == std::end(hunt_rows) ? hunt_rows[2] : *found;
}

// Gains that are inputs: their largest values, those of the parameters.
std::optional<double> most_gain(const Channel& channel) {
  const bool is_attitude = channel.topic() == "attitude_gains";
  if (!is_attitude && channel.topic() != "rate_gains") return std::nullopt;
  if (is_indexed(channel.field(), "p")) return is_attitude ? 12 : 0.6;
  if (is_indexed(channel.field(), "i")) return 0.5;
  if (is_indexed(channel.field(), "d")) return 0.01;
  if (is_indexed(channel.field(), "ff")) return 0.5;
  return std::nullopt;
}

// Inputs for which the law defines what NaN means.
bool may_be_nan(const Channel& channel) {
  constexpr std::array<std::string_view, 6> fields = {
      "in/vehicle_attitude_setpoint.yaw_sp_move_rate",
      "in/vehicle_rates_setpoint.roll",
      "in/vehicle_rates_setpoint.pitch",
      "in/vehicle_rates_setpoint.yaw",
      "in/hover_thrust_estimate.hover_thrust",
      "in/vehicle_local_position.unaided_heading"};
  const bool is_heading = channel.quantity == Quantity::angle;
  return (info_of(channel.module).is_of_cascade() || is_heading) &&
         std::ranges::find(fields, channel.name) != fields.end();
}

// A value close to `threshold`: float distances at the level exact, beyond the margins of the law
// at others.
double next_to(double threshold, Level level, HuntRandom& random) {
  if (level == Level::exact && random.chance(0.6)) {
    const auto at = static_cast<float>(threshold);
    const float towards = random.chance(0.5) ? 1e30F : -1e30F;
    return random.chance(0.4) ? at : std::nextafter(at, towards);
  }
  const double distance = std::pow(10, random.uniform(-4.3, -1.5));
  return threshold + (random.chance(0.5) ? distance : -distance);
}

std::array<double, 3> hunt_axis(HuntRandom& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(-pi, pi);
  const double r = std::sqrt(1 - z * z);
  switch (random.below(5)) {
    case 0:
      return {1, 0, 0};
    case 1:
      return {0, 1, 0};
    case 2:
      return {0, 0, 1};
    default:
      return {r * std::cos(angle), r * std::sin(angle), z};
  }
}

double hunt_angle(HuntRandom& random) {
  const double side = random.chance(0.5) ? 1 : -1;
  switch (random.below(7)) {
    case 0:
      return 0;
    case 1:
      return side * std::pow(10, random.uniform(-5, -1));
    case 2:
      return side * (pi - std::pow(10, random.uniform(-2.5, -0.3)));
    case 3:
      return side * pi / 2 + random.uniform(-0.01, 0.01);
    case 4:
      return random.uniform(-0.7, 0.7);
    default:
      return random.uniform(-pi, pi);
  }
}

std::uint64_t mixed(std::uint64_t seed, std::uint64_t trial) {
  std::uint64_t x = seed * 0x9e3779b97f4a7c15U + trial + 1;  // splitmix64
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

}  // namespace

HuntRandom::HuntRandom(std::uint64_t seed, std::uint64_t trial) : random_(mixed(seed, trial)) {}

std::size_t HuntRandom::below(std::size_t count) {
  return std::min(static_cast<std::size_t>(random_.uniform() * static_cast<double>(count)),
                  count - 1);
}

std::size_t HuntRandom::skewed(std::size_t least, std::size_t most) {
  const double ratio = static_cast<double>(most) / static_cast<double>(least);
  return static_cast<std::size_t>(static_cast<double>(least) * std::pow(ratio, random_.uniform()));
}

double extreme_value(HuntRandom& random) {
  using limits = std::numeric_limits<float>;
  constexpr std::array<float, 10> values = {limits::quiet_NaN(),
                                            limits::infinity(),
                                            -limits::infinity(),
                                            limits::max(),
                                            -limits::max(),
                                            limits::min(),
                                            limits::denorm_min(),
                                            -0.0F,
                                            1e10F,
                                            -1e10F};
  return random.one_of(values);
}

double hunt_value(const Channel& channel, Level level, HuntRandom& random) {
  if (const auto most = most_gain(channel)) {
    return random.chance(0.2) ? 0 : random.uniform(0, *most);
  }
  if (may_be_nan(channel) && random.chance(0.12)) return std::nan("");
  const HuntRow& values = values_of(channel);
  const std::size_t kind = random.below(10);
  if (kind < 2) return random.one_of(values.special);
  if (kind < 4) {
    const double special = random.one_of(values.special), value = next_to(special, level, random);
    // Beyond the range of the law only at the level exact.
    return level == Level::exact
               ? value
               : std::clamp(value, std::min(values.least, special), std::max(values.most, special));
  }
  if (kind < 6) return random.uniform(values.least, values.most) * 0.1;
  return random.uniform(values.least, values.most);
}

double hunt_byte(const Channel& channel, HuntRandom& random) {
  if (channel.quantity == Quantity::count) return static_cast<double>(random.below(13));
  if (random.chance(0.03)) return random.chance(0.5) ? 2 : 255;  // any other value is true
  return random.chance(0.5) ? 1 : 0;
}

std::int64_t hunt_time_us(const Channel& channel, double period_s, HuntRandom& random) {
  const double period_us = period_s * 1e6;
  if (is_indexed(channel.field(), "armed_time")) {
    return static_cast<std::int64_t>(random.uniform(-3e6, 1e6));
  }
  switch (random.below(6)) {
    case 0:
      return static_cast<std::int64_t>(-random.uniform(0, 3) * period_us);
    case 1:
      return static_cast<std::int64_t>(random.uniform(-1, 1) * period_us);
    case 2:
      return static_cast<std::int64_t>(-random.uniform(0, 2e6));
    default:
      return 0;
  }
}

float hunt_parameter(const Parameter& parameter, Level level, HuntRandom& random) {
  const double usual = parameter.default_value;
  const bool has_least = std::isfinite(parameter.min), has_most = std::isfinite(parameter.max);
  const double least = has_least ? parameter.min : 0;
  const double most = has_most               ? parameter.max
                      : parameter.is_integer ? usual + 12
                                             : std::max(4 * usual, 0.05);
  if (parameter.is_integer) {
    const double integer = std::floor(random.uniform(least, std::min(most + 1, least + 4)));
    return static_cast<float>(random.chance(0.1) ? most : integer);
  }
  if (!has_least && !has_most) {  // of the battery
    if (random.chance(0.2)) return parameter.default_value;
    return static_cast<float>(usual < 0 ? random.uniform(0, 0.05)
                                        : usual * random.uniform(0.8, 1.2));
  }
  double value = usual;
  switch (random.below(8)) {
    case 0:
      value = least;
      break;
    case 1:
      value = most;
      break;
    case 2:
      value = next_to(random.chance(0.5) ? least : most, level, random);
      break;
    case 3:  // the law has no limits of parameters
      return static_cast<float>(usual * random.uniform(0.5, 2));
    case 4:
      value = least + (most - least) * random.uniform(0, 0.1);
      break;
    default:
      value = random.uniform(least, most);
  }
  return static_cast<float>(std::clamp(value, least, most));
}

HuntRotation product(const HuntRotation& a, const HuntRotation& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

HuntRotation rotation(const std::array<double, 3>& axis, double angle_rad) {
  const double s = std::sin(angle_rad / 2);
  return {std::cos(angle_rad / 2), s * axis[0], s * axis[1], s * axis[2]};
}

// Components that are exactly 0, 1, -1, 1/2 or sqrt(1/2): on thresholds of the law.
HuntRotation exact_rotation(HuntRandom& random) {
  HuntRotation q{};
  const std::size_t first = random.below(4), second = random.below(4);
  const double side = random.chance(0.5) ? 1 : -1;
  switch (random.below(4)) {
    case 0:
      q[first] = q[second] = std::sqrt(0.5);
      if (first == second) q[first] = 1;
      q[second] *= side;
      return q;
    case 1:
      for (double& part : q) part = random.chance(0.5) ? 0.5 : -0.5;
      return q;
    default:
      q[first] = side;
      return q;
  }
}

HuntRotation hunt_rotation(HuntRandom& random) {
  if (random.chance(0.12)) return exact_rotation(random);
  HuntRotation q = rotation(hunt_axis(random), hunt_angle(random));
  if (random.chance(0.3)) q = product(rotation({0, 0, 1}, random.uniform(-pi, pi)), q);
  if (random.chance(0.3)) {
    for (double& part : q) part = -part;
  }
  return q;
}

}  // namespace attest
