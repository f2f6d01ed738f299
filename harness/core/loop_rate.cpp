#include "harness/core/loop_rate.hpp"

#include <fmt/format.h>

namespace attest {

Result<LoopRate> LoopRate::parse(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) {
    return Rate::parse(text).map([](const Rate& rate) { return LoopRate(rate); });
  }
  const auto attitude = Rate::parse(text.substr(0, colon));
  if (!attitude) return tl::unexpected(attitude.error());
  const auto rate = Rate::parse(text.substr(colon + 1));
  if (!rate) return tl::unexpected(rate.error());
  if (*rate < *attitude) {
    return fail(
        fmt::format("`{}`: the rate unit at {} Hz is slower than the attitude unit at {} "
                    "Hz; the attitude unit's rate comes first, as in 250:1000",
                    text, rate->to_string(), attitude->to_string()));
  }
  return LoopRate(*attitude, *rate);
}

std::string LoopRate::to_string() const {
  if (!attitude_unit) return motor_unit.to_string();
  return fmt::format("{}:{}", attitude_unit->to_string(), motor_unit.to_string());
}

std::string LoopRate::label() const {
  if (!attitude_unit) return motor_unit.label();
  std::string attitude = attitude_unit->label();
  attitude.resize(attitude.size() - 2);  // without "hz"
  return fmt::format("{}-{}", attitude, motor_unit.label());
}

}  // namespace attest
