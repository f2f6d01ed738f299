#include "controller/mc_att_control/parameters.hpp"

#include <cmath>
#include <set>
#include <string_view>

#include <gtest/gtest.h>

#include "controller/mc_att_control/gains.hpp"

namespace attest::mc_att_control {
namespace {

TEST(Parameters, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const ParameterInfo& info : parameter_table()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
  }
}

TEST(Parameters, EveryMemberHasOneEntry) {
  EXPECT_EQ(parameter_table().size() * sizeof(float), sizeof(Parameters));
  Parameters parameters{};
  for (const ParameterInfo& info : parameter_table()) {
    EXPECT_EQ(parameters.*info.member, 0.0f) << info.name << " shares its member";
    parameters.*info.member = 1.0f;
  }
}

TEST(Parameters, DefaultsAreInsideTheirRange) {
  for (const ParameterInfo& info : parameter_table()) {
    EXPECT_LE(info.min, info.default_value) << info.name;
    EXPECT_GE(info.max, info.default_value) << info.name;
    EXPECT_FALSE(info.unit.empty()) << info.name;
    EXPECT_FALSE(info.description.empty()) << info.name;
    EXPECT_EQ(find_parameter(parameter_table(), newest, info.name), &info);
  }
}

TEST(Parameters, SetByName) {
  Parameters parameters = default_parameters();
  EXPECT_EQ(parameters.mc_roll_p, 6.5f);
  EXPECT_TRUE(set_parameter(parameters, Profile::px4_v1_5_5, "MC_ROLL_P", 7.25f));
  EXPECT_EQ(parameters.mc_roll_p, 7.25f);
  EXPECT_FALSE(set_parameter(parameters, Profile::px4_v1_5_5, "MC_ROLL_PP", 1.0f));
  EXPECT_FALSE(set_parameter(parameters, Profile::px4_v1_5_5, "", 1.0f));
}

TEST(Parameters, IntegersTakeWholeNumbersOnly) {
  Parameters parameters = default_parameters();
  EXPECT_TRUE(set_parameter(parameters, Profile::px4_v1_5_5, "CBRK_RATE_CTRL", 140253.0f));
  EXPECT_FALSE(set_parameter(parameters, Profile::px4_v1_5_5, "MC_BAT_SCALE_EN", 0.5f));
  EXPECT_FALSE(set_parameter(parameters, Profile::px4_v1_5_5, "MC_BAT_SCALE_EN", NAN));
  EXPECT_FALSE(set_parameter(parameters, Profile::px4_v1_5_5, "MC_BAT_SCALE_EN", INFINITY));
  EXPECT_EQ(parameters.mc_bat_scale_en, 0.0f);
}

TEST(Parameters, OfAnotherProfileAreRefused) {
  for (const ParameterInfo& info : parameter_table()) {
    Parameters parameters = default_parameters();
    const bool is_set = set_parameter(parameters, Profile::px4_v1_3_4, info.name, 1.0f);
    EXPECT_EQ(is_set, info.profiles.contains(Profile::px4_v1_3_4)) << info.name;
  }
  Parameters parameters = default_parameters();
  for (const char* name : {"MC_TPA_BREAK", "MC_TPA_SLOPE", "MC_BAT_SCALE_EN"}) {
    EXPECT_FALSE(set_parameter(parameters, Profile::px4_v1_3_4, name, 1.0f)) << name;
    EXPECT_TRUE(set_parameter(parameters, Profile::px4_v1_5_5, name, 1.0f)) << name;
  }
}

TEST(Gains, TimeConstantsScaleProportionalAndDerivativeOfRollAndPitch) {
  Parameters parameters = default_parameters();
  const Gains<double> nominal = compute_gains<double>(parameters);
  parameters.mc_roll_tc = 0.1f;
  parameters.mc_pitch_tc = 0.4f;
  const Gains<double> scaled = compute_gains<double>(parameters);
  constexpr double tolerance = 1e-6;
  EXPECT_NEAR(scaled.attitude.proportional_1_s[0], 13.0, tolerance);
  EXPECT_NEAR(scaled.attitude.proportional_1_s[1], 3.25, tolerance);
  EXPECT_NEAR(scaled.rate.proportional[0], 0.3, tolerance);
  EXPECT_NEAR(scaled.rate.derivative[1], 0.0015, tolerance);
  EXPECT_EQ(scaled.attitude.proportional_1_s[2], nominal.attitude.proportional_1_s[2]);
  EXPECT_EQ(scaled.rate.integral, nominal.rate.integral);
  EXPECT_EQ(scaled.rate.feed_forward, nominal.rate.feed_forward);
}

TEST(Gains, DegreesBecomeRadians) {
  const Gains<double> gains = compute_gains<double>(default_parameters());
  EXPECT_NEAR(gains.attitude.rate_max_rad_s[0], 3.839724354, 1e-6);
  EXPECT_NEAR(gains.attitude.auto_rate_max_rad_s[2], 0.7853981634, 1e-6);
  EXPECT_NEAR(gains.acro_rate_max_rad_s[1], 6.283185307, 1e-6);
}

}  // namespace
}  // namespace attest::mc_att_control
