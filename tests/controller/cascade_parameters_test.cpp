#include <cmath>
#include <set>
#include <string_view>

#include <gtest/gtest.h>

#include "controller/cascade/gains.hpp"
#include "controller/cascade/parameters.hpp"

namespace attest::cascade {
namespace {

std::set<std::string_view> names_of(ParameterTable table, Profile profile) {
  std::set<std::string_view> names;
  for (const ParameterInfo& info : table) {
    if (!info.profiles.contains(profile)) continue;
    EXPECT_TRUE(names.insert(info.name).second) << info.name << " has two rows for a profile";
  }
  return names;
}

TEST(CascadeParameters, RowsAreCompleteAndFound) {
  for (const ParameterTable table : {attitude_parameters(), rate_parameters()}) {
    for (const ParameterInfo& info : table) {
      EXPECT_LE(info.min, info.default_value) << info.name;
      EXPECT_GE(info.max, info.default_value) << info.name;
      EXPECT_FALSE(info.unit.empty()) << info.name;
      EXPECT_FALSE(info.description.empty()) << info.name;
      EXPECT_EQ(find_parameter(table, info.profiles.newest, info.name), &info);
    }
  }
}

TEST(CascadeParameters, NoTwoShareAMemberInAProfile) {
  for (const Profile profile : every_profile) {
    std::set<const float*> members;
    const Parameters parameters{};
    for (const ParameterTable table : {attitude_parameters(), rate_parameters()}) {
      for (const ParameterInfo& info : table) {
        if (!info.profiles.contains(profile)) continue;
        EXPECT_TRUE(members.insert(&(parameters.*info.member)).second) << info.name;
      }
    }
  }
}

TEST(CascadeParameters, EveryMemberHasAName) {
  std::set<const float*> members;
  const Parameters parameters{};
  for (const ParameterTable table : {attitude_parameters(), rate_parameters()}) {
    for (const ParameterInfo& info : table) members.insert(&(parameters.*info.member));
  }
  EXPECT_EQ(members.size() * sizeof(float), sizeof(Parameters));
}

// The place of MPC_YAW_EXPO is a constant from v1.17 on, and MAN_DEADZONE is a new name.
TEST(CascadeParameters, CurveOfTheYawStickByProfile) {
  for (const Profile profile : {Profile::px4_v1_16_0, Profile::px4_v1_17, Profile::px4_v1_18}) {
    const auto gains =
        attitude_unit_gains<float>(default_parameters(attitude_parameters(), profile)).sticks;
    EXPECT_EQ(gains.yaw_expo, 0.6f);
    EXPECT_EQ(gains.yaw_deadzone, 0.1f);
  }
  const auto names = names_of(attitude_parameters(), Profile::px4_v1_17);
  EXPECT_TRUE(names.contains("MAN_DEADZONE"));
  EXPECT_FALSE(names.contains("MPC_HOLD_DZ"));
  EXPECT_FALSE(names.contains("MPC_YAW_EXPO"));
}

TEST(CascadeParameters, EachProfileHasItsOwn) {
  EXPECT_EQ(names_of(attitude_parameters(), Profile::px4_v1_16_0).size(), 19u);
  const auto v1_15_4 = names_of(attitude_parameters(), Profile::px4_v1_15_4);
  const auto v1_14_4 = names_of(attitude_parameters(), Profile::px4_v1_14_4);
  for (const char* name : {"MPC_HOLD_DZ", "MPC_YAW_EXPO", "MPC_MAN_Y_TAU"}) {
    EXPECT_FALSE(v1_15_4.contains(name)) << name;
  }
  EXPECT_TRUE(v1_15_4.contains("COM_SPOOLUP_TIME"));
  EXPECT_FALSE(v1_14_4.contains("COM_SPOOLUP_TIME"));
  EXPECT_FALSE(names_of(rate_parameters(), Profile::px4_v1_15_4).contains("MC_YAW_TQ_CUTOFF"));
}

TEST(CascadeParameters, DefaultsAndBoundsDifferByProfile) {
  EXPECT_EQ(default_parameters(rate_parameters(), Profile::px4_v1_14_4).mc_acro_y_max, 540.0f);
  EXPECT_EQ(default_parameters(rate_parameters(), Profile::px4_v1_15_4).mc_acro_y_max, 100.0f);
  EXPECT_EQ(default_parameters(rate_parameters(), Profile::px4_v1_14_4).mc_acro_expo, 0.69f);
  const auto tilt_max = [](Profile profile) {
    return find_parameter(attitude_parameters(), profile, "MPC_MAN_TILT_MAX")->max;
  };
  EXPECT_EQ(tilt_max(Profile::px4_v1_14_4), 90.0f);
  EXPECT_EQ(tilt_max(Profile::px4_v1_16_0), 70.0f);
}

TEST(CascadeParameters, SetByName) {
  Parameters values{};
  const auto set = [&values](ParameterTable table, std::string_view name, float value) {
    return set_parameter(values, table, Profile::px4_v1_15_4, name, value);
  };
  EXPECT_TRUE(set(attitude_parameters(), "MC_ROLL_P", 7.25f));
  EXPECT_EQ(values.mc_roll_p, 7.25f);
  EXPECT_FALSE(set(rate_parameters(), "MC_ROLL_P", 7.25f)) << "of the other unit";
  EXPECT_FALSE(set(attitude_parameters(), "MPC_YAW_EXPO", 0.5f)) << "of a newer profile";
  EXPECT_TRUE(set(attitude_parameters(), "MC_AIRMODE", 2.0f));
  EXPECT_FALSE(set(attitude_parameters(), "MC_AIRMODE", 0.5f));
  EXPECT_FALSE(set(attitude_parameters(), "MC_AIRMODE", NAN));
}

TEST(CascadeGains, RadiansAreOneMultiplication) {
  EXPECT_EQ(radians(220.0f), 220.0f * 0.0174532924f);
  EXPECT_NEAR(radians(180.0), M_PI, 1e-6);
}

TEST(CascadeGains, CutoffBecomesATimeConstant) {
  Parameters parameters = default_parameters(rate_parameters(), Profile::px4_v1_16_0);
  EXPECT_NEAR(rate_unit_gains<double>(parameters).yaw_torque_tau_s, 1 / (4 * M_PI), 1e-7);
  parameters.mc_yaw_tq_cutoff = 0.0f;
  EXPECT_EQ(rate_unit_gains<double>(parameters).yaw_torque_tau_s, 0.0);
}

}  // namespace
}  // namespace attest::cascade
