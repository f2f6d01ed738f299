#include <string>

#include <gtest/gtest.h>

#include "controller/cascade/parameters.hpp"
#include "controller/cascade/profile.hpp"
#include "controller/cascade/unit.hpp"
#include "tests/controller/allocation_count.hpp"

namespace attest::cascade {
namespace {

template <typename Unit>
struct Io;
template <>
struct Io<attest_attitude_unit> {
  static constexpr const char* id = ATTEST_EXTENSION_ATTITUDE_UNIT;
  static constexpr auto parameters = attitude_parameters;
  static constexpr const char* newer_parameter = "COM_SPOOLUP_TIME";  // than v1.14.4
  attest_attitude_inputs in{};
  attest_attitude_outputs out{};
};
template <>
struct Io<attest_rate_unit> {
  static constexpr const char* id = ATTEST_EXTENSION_RATE_UNIT;
  static constexpr auto parameters = rate_parameters;
  static constexpr const char* newer_parameter = "MC_YAW_TQ_CUTOFF";
  attest_rate_inputs in{};
  attest_rate_outputs out{};
};

template <typename Unit>
class CascadeUnit : public ::testing::Test {
 protected:
  const Unit& unit() { return *static_cast<const Unit*>(cascade_unit()->extension(Io<Unit>::id)); }
};
using Units = ::testing::Types<attest_attitude_unit, attest_rate_unit>;
TYPED_TEST_SUITE(CascadeUnit, Units);

TYPED_TEST(CascadeUnit, KnowsItsProfiles) {
  for (const Profile profile : every_profile) {
    const std::string name(name_of(profile));
    void* const self = this->unit().create(name.c_str());
    EXPECT_NE(self, nullptr) << name;
    this->unit().destroy(self);
  }
  EXPECT_EQ(this->unit().create("px4-v1.5.5"), nullptr);
  EXPECT_EQ(this->unit().create(nullptr), nullptr);
}

TYPED_TEST(CascadeUnit, TakesTheParametersOfItsProfile) {
  for (const Profile profile : every_profile) {
    void* const self = this->unit().create(std::string(name_of(profile)).c_str());
    const auto set = [&](std::string_view name) {
      return this->unit().set_parameter(self, std::string(name).c_str(), 1.0f);
    };
    for (const ParameterInfo& info : Io<TypeParam>::parameters()) {
      if (!info.profiles.contains(profile)) continue;
      EXPECT_EQ(set(info.name), ATTEST_OK) << info.name;
    }
    if (profile == Profile::px4_v1_14_4) {
      EXPECT_EQ(set(Io<TypeParam>::newer_parameter), ATTEST_INVALID);
    }
    EXPECT_EQ(set("MC_ROLL_Q"), ATTEST_INVALID);
    this->unit().destroy(self);
  }
}

TYPED_TEST(CascadeUnit, RefusesNull) {
  Io<TypeParam> io;
  EXPECT_EQ(this->unit().step(nullptr, &io.in, &io.out), ATTEST_INVALID);
  EXPECT_EQ(this->unit().set_parameter(nullptr, "MC_ROLL_P", 1.0f), ATTEST_INVALID);
  this->unit().destroy(nullptr);
}

TYPED_TEST(CascadeUnit, AllocatesOnlyInCreate) {
  void* const self = this->unit().create("px4-v1.16.0");
  Io<TypeParam> io;
  const std::size_t before = test::allocation_count();
  for (unsigned i = 0; i < 300; ++i) {
    io.in.timestamp += 1000;
    io.in.updated = i;
    this->unit().set_parameter(self, "MC_ROLL_P", 6.0f);
    this->unit().step(self, &io.in, &io.out);
  }
  EXPECT_EQ(test::allocation_count(), before);
  this->unit().destroy(self);
}

TYPED_TEST(CascadeUnit, ComputesInDoubleToo) {
  const auto* in_double =
      static_cast<const TypeParam*>(cascade_unit_in_double()->extension(Io<TypeParam>::id));
  EXPECT_NE(in_double, &this->unit());
  void* const self = in_double->create("px4-v1.16.0");
  Io<TypeParam> io;
  EXPECT_EQ(in_double->step(self, &io.in, &io.out), ATTEST_OK);
  in_double->destroy(self);
}

TEST(CascadeExtension, HasTheTwoUnitsOnly) {
  EXPECT_EQ(cascade_unit()->extension("attest.mixer.v1"), nullptr);
  EXPECT_EQ(cascade_unit()->extension(nullptr), nullptr);
}

}  // namespace
}  // namespace attest::cascade
