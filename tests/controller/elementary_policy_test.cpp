#include <bit>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/elementary/float_with.hpp"
#include "controller/mc_att_control/tailsitter_recovery_definition.hpp"
#include "tests/controller/cascade_walk.hpp"

namespace attest::elementary {
namespace {

struct OwnFunctions {
  static float sin(float x) { return attest_sinf(x); }
  static float cos(float x) { return attest_cosf(x); }
  static float asin(float x) { return attest_asinf(x); }
  static float acos(float x) { return attest_acosf(x); }
  static float exp(float x) { return attest_expf(x); }
  static float atan2(float y, float x) { return attest_atan2f(y, x); }
};

// Each result is one ulp too small.
struct InaccurateFunctions {
  inline static std::string_view caller;
  inline static std::set<std::string_view> callers;
  static float below(float x) {
    callers.insert(caller);
    return std::nextafter(x, -INFINITY);
  }
  static float sin(float x) { return below(attest_sinf(x)); }
  static float cos(float x) { return below(attest_cosf(x)); }
  static float asin(float x) { return below(attest_asinf(x)); }
  static float acos(float x) { return below(attest_acosf(x)); }
  static float exp(float x) { return below(attest_expf(x)); }
  static float atan2(float y, float x) { return below(attest_atan2f(y, x)); }
};

// The bits of all results; each NaN is the same.
using Bits = std::vector<std::uint32_t>;

void add(Bits& bits, float value) {
  bits.push_back(std::isnan(value) ? 0x7fc00000 : std::bit_cast<std::uint32_t>(value));
}

template <typename Scalar>
Bits attitude_unit_outputs() {
  Bits bits;
  const auto walks = test::attitude_walks();
  // Some of them: all take half a minute without optimisation.
  for (std::size_t i = 0; i < walks.size(); i += 16) {
    const auto& walk = walks[i];
    const auto profile = cascade::every_profile[i / 16 % cascade::every_profile.size()];
    cascade::AttitudeUnit<Scalar> unit(profile);
    for (const auto& [name, value] : walk.parameters) unit.set_parameter(name, value);
    attest_attitude_outputs out{};
    for (const auto& step : walk.steps) {
      if (step.set) unit.set_parameter(step.set->first, step.set->second);
      unit.step(step.in, out);
      add(bits, out.vehicle_rates_setpoint.roll);
      add(bits, out.vehicle_rates_setpoint.pitch);
      add(bits, out.vehicle_rates_setpoint.yaw);
      for (const float q : out.vehicle_attitude_setpoint.q_d) add(bits, q);
    }
  }
  return bits;
}

template <typename Scalar>
Bits recovery_outputs() {
  using Stages = mc_att_control::RecoveryStages<Scalar>;
  Bits bits;
  for (int i = 0; i < 100; ++i) {
    const float half = 0.015f * static_cast<float>(i), c = attest_cosf(half), s = attest_sinf(half);
    const mc_att_control::Quaternion<Scalar> q_WB{Scalar(c), Scalar(0.6f * s), Scalar(0.8f * s), 0};
    const auto tilt = Stages::tilt(q_WB, {1, 0, 0, 0});
    add(bits, float(tilt.angle_rad));
    add(bits, float(tilt.direction_rad));
    const auto rates = Stages::optimal_rates(tilt);
    for (int axis = 0; axis < 3; ++axis) add(bits, float(rates[axis]));
  }
  return bits;
}

TEST(ElementaryPolicy, LawTakesTheFunctionsOfItsScalar) {
  const Bits law = attitude_unit_outputs<float>();
  EXPECT_EQ(law, attitude_unit_outputs<FloatWith<OwnFunctions>>());
  EXPECT_NE(law, attitude_unit_outputs<FloatWith<InaccurateFunctions>>());
}

TEST(ElementaryPolicy, RecoveryTakesTheFunctionsOfItsScalar) {
  const Bits law = recovery_outputs<float>();
  EXPECT_EQ(law, recovery_outputs<FloatWith<OwnFunctions>>());
  EXPECT_NE(law, recovery_outputs<FloatWith<InaccurateFunctions>>());
}

TEST(ElementaryPolicy, FunctionsCanAskWhichFunctionOfTheLawCallsThem) {
  InaccurateFunctions::callers.clear();
  recovery_outputs<FloatWith<InaccurateFunctions>>();
  EXPECT_EQ(InaccurateFunctions::callers,
            (std::set<std::string_view>{"arc_cosine", "optimal_rates", "tilt", "times_sigmoid"}));
}

}  // namespace
}  // namespace attest::elementary
