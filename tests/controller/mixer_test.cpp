#include "controller/actuation/mixer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "controller/actuation/mixer_geometry.hpp"
#include "tests/controller/generators.hpp"

namespace attest::actuation {
namespace {

using test::uniform;
using Controls = MixerControls<float>;
using ::testing::HasSubstr;

Mixer make_mixer(const std::string& geometry) {
  return Mixer(parse_mixer("R: " + geometry + " 10000 10000 10000 0").value());
}

Mixer any_mixer() {
  const auto geometries = mixer_geometries();
  const auto index = *rc::gen::inRange<std::size_t>(0, geometries.size());
  return make_mixer(std::string(geometries[index].name));
}

float draw(double low, double high) { return static_cast<float>(*uniform(low, high)); }

Controls any_controls() {
  return {draw(-1.5, 1.5), draw(-1.5, 1.5), draw(-1.5, 1.5), draw(-0.2, 1.2)};
}

TEST(Mixer, BadTextIsRefusedWithAReason) {
  const auto message = [](const char* text) { return parse_mixer(text).error(); };
  EXPECT_THAT(message(""), HasSubstr("expected 'R:"));
  EXPECT_THAT(message("M: 4x 1 1 1 0"), HasSubstr("expected 'R:"));
  EXPECT_THAT(message("R: 5x 1 1 1 0"), HasSubstr("unknown geometry '5x', known are 4x 4+ 6x 8x"));
  EXPECT_THAT(message("R: 4x 10000 10000"), HasSubstr("yaw must be an integer in 1/10000"));
  EXPECT_THAT(message("R: 4x 10000 1.5 0 0"), HasSubstr("pitch must be an integer"));
  EXPECT_THAT(message("R: 4x 1 1 1 0 0"), HasSubstr("unexpected '0' after the deadband"));
}

TEST(Mixer, GeometriesTurnWithoutResidue) {
  for (const MixerGeometry& geometry : mixer_geometries()) {
    float roll = 0.0f, pitch = 0.0f, yaw = 0.0f;
    for (const Rotor& rotor : geometry.rotors) {
      EXPECT_NEAR(std::hypot(rotor.roll, rotor.pitch), 1.0f, 2e-6f) << geometry.name;
      roll += rotor.roll;
      pitch += rotor.pitch;
      yaw += rotor.yaw;
    }
    EXPECT_EQ(yaw, 0.0f) << geometry.name;
    EXPECT_NEAR(roll, 0.0f, 1e-6f) << geometry.name;
    EXPECT_NEAR(pitch, 0.0f, 1e-6f) << geometry.name;
  }
}

TEST(Mixer, RollRightRaisesTheLeftRotors) {
  Mixer mixer = make_mixer("4x");
  Saturation saturation{};
  const auto out = mixer.mix({0.1f, 0.0f, 0.0f, 0.5f}, 0.0f, saturation);
  EXPECT_LT(out[0], 0.0f);  // front right
  EXPECT_GT(out[1], 0.0f);  // rear left
  EXPECT_GT(out[2], 0.0f);  // front left
  EXPECT_LT(out[3], 0.0f);  // rear right
}

TEST(Mixer, DeadbandLiftsTheIdle) {
  Mixer mixer(parse_mixer("R: 4x 8000 9000 5000 1500").value());
  Saturation saturation{};
  for (const float out : mixer.mix({0, 0, 0, 0}, 0.0f, saturation)) EXPECT_FLOAT_EQ(out, -0.7f);
  for (const float out : mixer.mix({0, 0, 0, 1}, 0.0f, saturation)) EXPECT_FLOAT_EQ(out, 1.0f);
}

// Without saturation each rotor gets its linear share, and the shares add up to the thrust.
RC_GTEST_PROP(Mixer, SmallControlsMixLinearly, ()) {
  Mixer mixer = any_mixer();
  const Controls c{draw(-0.1, 0.1), draw(-0.1, 0.1), draw(-0.1, 0.1), draw(0.4, 0.6)};
  Saturation saturation{};
  const auto out = mixer.mix(c, 0.0f, saturation);
  RC_ASSERT(!saturation.lower && !saturation.upper && !saturation.yaw);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Rotor& rotor = mixer.rotors()[i];
    const float share = c.roll * rotor.roll + c.pitch * rotor.pitch + c.yaw * rotor.yaw + c.thrust;
    RC_ASSERT(std::abs(out[i] - (2.0f * share - 1.0f)) < 1e-6f);
  }
  const float sum = std::accumulate(out.begin(), out.end(), 0.0f);
  const auto count = static_cast<float>(out.size());
  RC_ASSERT(std::abs(sum - count * (2.0f * c.thrust - 1.0f)) < 1e-5f);
}

RC_GTEST_PROP(Mixer, CommandsStayInRange, ()) {
  Mixer mixer = any_mixer();
  Saturation saturation{};
  for (const float out : mixer.mix(any_controls(), 0.0f, saturation)) {
    RC_ASSERT(out >= -1.0f);
    RC_ASSERT(out <= 1.0f);
  }
}

RC_GTEST_PROP(Mixer, FlagsSayWhetherRollAndPitchFit, ()) {
  Mixer mixer = any_mixer();
  const Controls c{draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(0, 1)};
  Saturation saturation{};
  mixer.mix(c, 0.0f, saturation);
  float low = 1.0f, high = 0.0f;
  for (const Rotor& rotor : mixer.rotors()) {
    const float out = c.roll * rotor.roll + c.pitch * rotor.pitch + c.thrust;
    low = std::min(low, out);
    high = std::max(high, out);
  }
  RC_PRE(std::abs(low) > 1e-6f && std::abs(high - 1.0f) > 1e-6f);
  RC_ASSERT(saturation.lower == (low < 0.0f));
  RC_ASSERT(saturation.upper == (high > 1.0f));
}

TEST(Mixer, FirstCallIsLimitedFrom0OnlyWithADeadband) {
  Saturation saturation{};
  Mixer without = make_mixer("4x");
  for (const float out : without.mix({0, 0, 0, 1}, 0.1f, saturation)) EXPECT_FLOAT_EQ(out, 1.0f);
  Mixer with(parse_mixer("R: 4x 10000 10000 10000 1000").value());
  for (const float out : with.mix({0, 0, 0, 1}, 0.1f, saturation)) EXPECT_FLOAT_EQ(out, 0.1f);
}

RC_GTEST_PROP(Mixer, SlewLimitHoldsFromCallToCall, ()) {
  Mixer mixer = any_mixer();
  constexpr float delta = 0.05f;
  Saturation saturation{};
  const auto first = mixer.mix(any_controls(), 0.0f, saturation);
  std::vector<float> previous(first.begin(), first.end());
  for (int call = 0; call < 20; ++call) {
    const auto out = mixer.mix(any_controls(), delta, saturation);
    for (std::size_t i = 0; i < out.size(); ++i) {
      RC_ASSERT(std::abs(out[i] - previous[i]) <= delta + 1e-6f);
    }
    previous.assign(out.begin(), out.end());
  }
}

}  // namespace
}  // namespace attest::actuation
