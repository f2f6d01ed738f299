#include "harness/compare/tolerance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace attest {
namespace {

Tolerance default_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::rate:
      return Tolerances::rate;
    case Quantity::control:
      return Tolerances::control;
    case Quantity::integral:
      return Tolerances::integral;
    case Quantity::thrust:
      return Tolerances::passed_through;
    case Quantity::motor:
      return Tolerances::motor;
    case Quantity::scale:
      return Tolerances::scale;
    case Quantity::quaternion:
      return Tolerances::quaternion;
    default:
      return {};  // time and flags have no tolerance
  }
}

// The least absolute tolerance for a fixed-point port, in LSBs.
double lsb_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::rate:
      return Tolerances::rate_lsb;
    case Quantity::control:
      return Tolerances::control_lsb;
    case Quantity::integral:
      return Tolerances::integral_lsb;
    case Quantity::scale:
      return Tolerances::scale_lsb;
    case Quantity::motor:
      return Tolerances::motor_lsb;
    case Quantity::quaternion:
      return Tolerances::quaternion_lsb;
    case Quantity::thrust:
      return 16;  // copied, at most scaled
    default:
      return 0;
  }
}

}  // namespace

std::string_view name_of(Level level) {
  switch (level) {
    case Level::exact:
      return "exact";
    case Level::numeric:
      return "numeric";
    case Level::events:
      return "events";
  }
  return "";
}

Result<Level> parse_level(std::string_view text) {
  for (const Level level : {Level::exact, Level::numeric, Level::events}) {
    if (text == name_of(level)) return level;
  }
  return fail(fmt::format("unknown level `{}`; use exact, numeric or events", text));
}

Tolerances::Tolerances(Level level) : level_(level) {
  if (level != Level::numeric) return;
  const auto table = channels();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].is_output()) of_channel_[i] = default_of(table[i].quantity);
  }
}

bool Tolerances::set(std::string_view prefix, Tolerance tolerance) {
  const std::string beginning = fmt::format("out/{}", prefix);
  const auto table = channels();
  bool any = false;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!table[i].name.starts_with(beginning) || table[i].type != ChannelType::f32) continue;
    any = true;
    if (level_ == Level::numeric) of_channel_[i] = tolerance;
  }
  return any;
}

void Tolerances::allow_lsb(int fraction_bits, std::size_t ticks) {
  if (level_ != Level::numeric) return;
  const auto table = channels();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!table[i].is_output()) continue;
    auto& [absolute, relative] = of_channel_[i];
    const Quantity quantity = table[i].quantity;
    const bool integrates = quantity == Quantity::integral || quantity == Quantity::control;
    const double lsb = lsb_of(quantity) + (integrates ? static_cast<double>(ticks) : 0);
    absolute = std::max(absolute, std::ldexp(lsb, -fraction_bits));
    if (quantity != Quantity::control) continue;
    relative = std::max(relative, std::ldexp(control_relative_lsb, -fraction_bits));
  }
}

Tolerances Tolerances::scaled(double factor) const {
  Tolerances result = *this;
  result.scale_ *= factor;
  for (Tolerance& tolerance : result.of_channel_) {
    tolerance.absolute *= factor;
    tolerance.relative *= factor;
  }
  return result;
}

double Tolerances::widening(double error_rad, double gain) const {
  // Measured with correct builds: 3e-6 rad/s at one radian from 180 deg with the default gain.
  constexpr double noise_rad_s = 3e-6;
  constexpr double default_gain = 6.5;
  // 0.1 deg. There the widening is as large as the smallest error of a wrong port, so it does not
  // grow further. Vectors nearer to 180 deg belong to the exact level.
  constexpr double nearest_rad = 1.7e-3;
  const double distance = std::max(std::numbers::pi - error_rad, nearest_rad);
  return scale_ * noise_rad_s * (gain / default_gain) / distance;
}

}  // namespace attest
