// Each fault of the cascade changes an output of a unit, in those profiles that it names and in no
// other.
#include <cmath>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "controller/cascade/unit_table.hpp"
#include "controller/faults/faulty_controller.hpp"
#include "tests/controller/cascade_walk.hpp"

namespace attest::faults {
namespace {

using cascade::every_profile;
using test::Walk;

// The floats of the topics that both publish, or a difference in what they publish.
template <typename Topic>
bool differs(const Topic& a, const Topic& b, float tolerance) {
  if (a.published != b.published) return true;
  if (a.published == 0) return false;
  constexpr std::size_t count = offsetof(Topic, published) / sizeof(float);
  float x[count], y[count];
  std::memcpy(x, &a, sizeof x);
  std::memcpy(y, &b, sizeof y);
  for (std::size_t i = 0; i < count; ++i) {
    if (std::isnan(x[i]) != std::isnan(y[i])) return true;
    if (std::abs(x[i] - y[i]) > tolerance * std::max(1.0f, std::abs(y[i]))) return true;
  }
  return false;
}

bool differs(const attest_attitude_outputs& a, const attest_attitude_outputs& b, float tolerance) {
  return differs(a.vehicle_rates_setpoint, b.vehicle_rates_setpoint, tolerance) ||
         differs(a.vehicle_attitude_setpoint, b.vehicle_attitude_setpoint, tolerance);
}

bool differs(const attest_rate_outputs& a, const attest_rate_outputs& b, float tolerance) {
  return differs(a.vehicle_torque_setpoint, b.vehicle_torque_setpoint, tolerance) ||
         differs(a.vehicle_thrust_setpoint, b.vehicle_thrust_setpoint, tolerance) ||
         differs(a.rate_ctrl_status, b.rate_ctrl_status, tolerance) ||
         differs(a.vehicle_rates_setpoint, b.vehicle_rates_setpoint, tolerance);
}

// The walks of one unit, and what the law answers in each profile.
template <typename Unit>
class Answered {
 public:
  using Inputs = typename Unit::Inputs;
  using Outputs = typename Unit::Outputs;

  explicit Answered(std::vector<Walk<Inputs>> walks) : walks_(std::move(walks)) {
    for (const cascade::Profile profile : every_profile) {
      auto& of_profile = law_.emplace_back();
      for (const Walk<Inputs>& walk : walks_) {
        auto& of_walk = of_profile.emplace_back();
        step_through(profile, {}, walk, [&](std::size_t, const Outputs& out) {
          of_walk.push_back(out);
          return true;
        });
      }
    }
  }

  // Whether the unit with that fault differs from the law by more than the tolerance in a walk.
  bool tells(cascade::Profile profile, const Fault& fault, std::size_t walk,
             float tolerance) const {
    bool told = false;
    step_through(profile, {{&fault}}, walks_[walk], [&](std::size_t i, const Outputs& out) {
      told = differs(out, law(profile, walk)[i], tolerance);
      return !told;
    });
    return told;
  }

  const std::vector<Walk<Inputs>>& walks() const { return walks_; }
  const std::vector<Outputs>& law(cascade::Profile profile, std::size_t walk) const {
    return law_[static_cast<std::size_t>(profile)][walk];
  }

 private:
  template <typename Use>
  static void step_through(cascade::Profile profile, const std::vector<const Fault*>& faults,
                           const Walk<Inputs>& walk, Use use) {
    Unit unit(profile, faults);
    for (const auto& [name, value] : walk.parameters) unit.set_parameter(name, value);
    Outputs out{};
    for (std::size_t i = 0; i < walk.steps.size(); ++i) {
      const auto& step = walk.steps[i];
      if (step.set) unit.set_parameter(step.set->first, step.set->second);
      unit.step(step.in, out);
      if (!use(i, out)) return;
    }
  }

  std::vector<Walk<Inputs>> walks_;
  std::vector<std::vector<std::vector<Outputs>>> law_;  // by profile and walk
};

const Answered<FaultyAttitudeUnit>& attitude() {
  static const Answered<FaultyAttitudeUnit> answered(test::attitude_walks());
  return answered;
}
const Answered<FaultyRateUnit>& rate() {
  static const Answered<FaultyRateUnit> answered(test::rate_walks());
  return answered;
}

// In any walk of any unit; with `every`, in any of that share of the walks.
bool is_told(cascade::Profile profile, const Fault& fault, float tolerance, std::size_t every = 1) {
  for (std::size_t w = 0; w < attitude().walks().size(); w += every) {
    if (attitude().tells(profile, fault, w, tolerance)) return true;
    if (rate().tells(profile, fault, w, tolerance)) return true;
  }
  return false;
}

std::vector<const Fault*> cascade_faults() {
  std::vector<const Fault*> faults;
  for (const Fault* fault : catalogue()) {
    if (fault->profiles->is_of_law_of("px4-v1.16.0")) faults.push_back(fault);
  }
  return faults;
}

TEST(CascadeFaults, AreMany) { EXPECT_GE(cascade_faults().size(), 150u); }

TEST(CascadeFaults, AreDetectableInProfilesOfTheCascadeOnly) {
  for (const Fault* fault : cascade_faults()) {
    EXPECT_FALSE(fault->is_detectable("px4-v1.5.5")) << fault->id;
    EXPECT_FALSE(fault->profiles->is_of_law_of("px4-v1.5.5")) << fault->id;
    EXPECT_FALSE(fault->is_detectable("px4-v1.0.0")) << fault->id;
  }
}

// All, but with a sanitizer only one of `one_of`: walks of all take minutes there, and it looks for
// other mistakes.
std::vector<const Fault*> walked_faults([[maybe_unused]] std::size_t one_of) {
#ifdef NDEBUG
  constexpr std::size_t every = 1;
#else
  const std::size_t every = one_of;
#endif
  std::vector<const Fault*> walked;
  const std::vector<const Fault*> all = cascade_faults();
  for (std::size_t i = 0; i < all.size(); i += every) walked.push_back(all[i]);
  return walked;
}

// More than rounding. Faults of the group `instances` show only with a second instance.
TEST(CascadeFaults, EachIsToldFromTheLawInItsProfiles) {
  constexpr float tolerance = 1e-5f;
  for (const Fault* fault : walked_faults(32)) {
    if (fault->group == "instances") continue;
    for (const cascade::Profile profile : every_profile) {
      if (!fault->is_detectable(name_of(profile))) continue;
      EXPECT_TRUE(is_told(profile, *fault, tolerance)) << fault->id << " in " << name_of(profile);
    }
  }
}

// Not by one bit, so the profiles of a fault are all that there are. Faults that are equivalent to
// the law may differ by rounding. A quarter of the walks is enough, because a fault that acts in
// another profile acts in many of them.
TEST(CascadeFaults, EachIsTheLawInTheOtherProfiles) {
  for (const Fault* fault : walked_faults(64)) {  // each walk is walked to its end
    const float tolerance = fault->equivalent.empty() ? 0.0f : 1e-4f;
    for (const cascade::Profile profile : every_profile) {
      if (fault->is_detectable(name_of(profile))) continue;
      EXPECT_FALSE(is_told(profile, *fault, tolerance, 4))
          << fault->id << " in " << name_of(profile);
    }
  }
}

// Whether the fault acts although no parameter is set.
template <typename Unit>
bool acts_at_defaults(cascade::Profile profile, const Fault& fault,
                      const Answered<Unit>& answered) {
  const Fault* const one[] = {&fault};
  Unit law(profile, {}), faulty(profile, one);
  typename Unit::Outputs right{}, out{};
  for (const auto& step : answered.walks().front().steps) {
    law.step(step.in, right);
    faulty.step(step.in, out);
    if (differs(out, right, 0)) return true;
  }
  return false;
}

// A default of another release would be a second mistake.
TEST(CascadeFaults, AParameterThatIsNotReadHasTheDefaultOfItsProfile) {
  std::size_t count = 0;
  for (const Fault* fault : cascade_faults()) {
    if (!fault->id.ends_with("-not-read")) continue;
    for (const cascade::Profile profile : every_profile) {
      if (!fault->is_detectable(name_of(profile))) continue;
      ++count;
      EXPECT_FALSE(acts_at_defaults(profile, *fault, attitude())) << fault->id;
      EXPECT_FALSE(acts_at_defaults(profile, *fault, rate())) << fault->id << name_of(profile);
    }
  }
  EXPECT_GE(count, 60u);
}

// An instance with a fault has no effect on another one.
TEST(CascadeFaults, InstancesShareNothing) {
  const auto& walk = attitude().walks().front();
  for (const Fault* fault : cascade_faults()) {
    const Fault* const one[] = {fault};
    FaultyAttitudeUnit first(cascade::Profile::px4_v1_16_0, one);
    attest_attitude_outputs once{}, again{};
    for (const auto& step : walk.steps) first.step(step.in, once);
    FaultyAttitudeUnit second(cascade::Profile::px4_v1_16_0, one);
    for (const auto& step : walk.steps) second.step(step.in, again);
    EXPECT_FALSE(differs(once, again, 0)) << fault->id;
  }
}

template <typename Table, typename Unit>
void expect_reference(const Answered<Unit>& answered) {
  for (const cascade::Profile profile : every_profile) {
    for (std::size_t w = 0; w < answered.walks().size(); ++w) {
      const auto& walk = answered.walks()[w];
      void* const self = Table::table.create(std::string(name_of(profile)).c_str());
      for (const auto& [name, value] : walk.parameters) {
        Table::table.set_parameter(self, std::string(name).c_str(), value);
      }
      typename Unit::Outputs out{};
      for (std::size_t i = 0; i < walk.steps.size(); ++i) {
        const auto& set = walk.steps[i].set;
        if (set) Table::table.set_parameter(self, std::string(set->first).c_str(), set->second);
        Table::table.step(self, &walk.steps[i].in, &out);
        ASSERT_FALSE(differs(out, answered.law(profile, w)[i], 0)) << w << " step " << i;
      }
      Table::table.destroy(self);
    }
  }
}

TEST(FaultyUnits, WithoutAFaultAreTheReference) {
  expect_reference<cascade::AttitudeUnitTable<float>>(attitude());
  expect_reference<cascade::RateUnitTable<float>>(rate());
}

// Each changes the stage that it finds, so both act, also in one stage.
TEST(FaultyUnits, TwoFaultsOfOneStageActTogether) {
  const Fault* const signs[] = {find_fault("cascade-i-reversed"), find_fault("cascade-d-missing")};
  const Vector one = Vector::Ones(), two = 2 * one, three = 3 * one, four = 4 * one;
  EXPECT_EQ(law_with(signs).rate_unit.rate.torque(one, two, three, four), Vector(one - two + four));
  const Fault* const landed[] = {find_fault("cascade-landed-ignored"),
                                 find_fault("cascade-maybe-landed-ignored")};
  EXPECT_TRUE(law_with(landed).rate_unit.rate.may_integrate(true, true));
  const Fault* const yaw[] = {find_fault("cascade-yaw-weight-by-lerp"),
                              find_fault("cascade-yaw-angle-halved")};
  EXPECT_EQ(law_with(yaw).attitude_unit.attitude.weighted_yaw(0.5f, 0.8f, 0.5f),
            Quat(0.875f, 0, 0, 0.2f));
}

TEST(FaultyUnits, TwoFaultsActTogether) {
  const Fault* const both[] = {find_fault("cascade-rate-thrust-up"),
                               find_fault("cascade-d-missing")};
  ASSERT_TRUE(both[0] && both[1]);
  FaultyRateUnit unit(cascade::Profile::px4_v1_15_4, both);
  attest_rate_inputs in{};
  in.timestamp = in.vehicle_angular_velocity.timestamp_sample = 1000000;
  in.updated =
      ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE | ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
  in.vehicle_control_mode = {1, 0, 1, 1};
  in.vehicle_rates_setpoint.thrust_body[2] = -0.6f;
  in.vehicle_angular_velocity.xyz_derivative[0] = 10;
  attest_rate_outputs out{};
  unit.step(in, out);
  EXPECT_EQ(out.vehicle_thrust_setpoint.xyz[2], 0.6f);
  EXPECT_EQ(out.vehicle_torque_setpoint.xyz[0], 0.0f);
}

}  // namespace
}  // namespace attest::faults
