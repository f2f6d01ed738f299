// The catalogue itself. `attest faults` tests with the suite that each fault is wrong, and how
// soon it is caught.
#include <cstddef>
#include <cstring>
#include <set>

#include <gtest/gtest.h>

#include "controller/faults/faulty_controller.hpp"
#include "controller/mc_att_control/unit.hpp"

namespace attest::faults {
namespace {

TEST(Catalogue, EveryFaultIsNamedAndExplained) {
  std::set<std::string_view> ids;
  for (const Fault* fault : catalogue()) {
    EXPECT_TRUE(ids.insert(fault->id).second) << fault->id << " is there twice";
    EXPECT_EQ(find_fault(fault->id), fault);
    for (const auto text : {fault->group, fault->what, fault->shows, fault->kind}) {
      EXPECT_FALSE(text.empty()) << fault->id;
    }
    EXPECT_FALSE(name_of(fault->stage).empty());
  }
  EXPECT_GE(ids.size(), 150u);
  EXPECT_EQ(find_fault("no such fault"), nullptr);
}

attest_inputs tick(std::uint64_t i) {
  attest_inputs in{};
  in.timestamp = 5'000'000 + 4000 * i;
  in.updated = i == 0 ? 0x1ffu : 0u;
  const float x = 0.01f * static_cast<float>(i);
  const float w = std::sqrt(1 - x * x);
  in.control_state = {{w, x, 0, 0}, 0.1f, -x, 0.2f};
  in.vehicle_attitude_setpoint = {{1, 0, 0, 0}, 0.6f, 0, 0.5f, 0};
  in.vehicle_control_mode = {1, 0, 1, 1, 0, 0};
  in.actuator_armed.armed = 1;
  in.vehicle_status.is_rotary_wing = 1;
  return in;
}

// Whether the topics have the same bytes. The padding after `published` may have any value.
bool same_answers(const attest_outputs& a, const attest_outputs& b) {
  const auto same = []<typename Topic>(const Topic& x, const Topic& y) {
    return std::memcmp(&x, &y, offsetof(Topic, published) + sizeof x.published) == 0;
  };
  return same(a.vehicle_rates_setpoint, b.vehicle_rates_setpoint) &&
         same(a.actuator_controls_0, b.actuator_controls_0) &&
         same(a.mc_att_ctrl_status, b.mc_att_ctrl_status);
}

attest_outputs flown(FaultyController& controller) {
  attest_outputs out{};
  for (std::uint64_t i = 0; i < 50; ++i) controller.step(tick(i), out);
  return out;
}

TEST(FaultyController, WithoutAFaultIsTheReferenceToTheBit) {
  FaultyController controller(Profile::px4_v1_5_5, {});
  const attest_unit& unit = *mc_att_control::mc_att_control_unit();
  void* const self = unit.create("px4-v1.5.5");
  attest_outputs got{}, want{};
  for (std::uint64_t i = 0; i < 50; ++i) {
    const attest_inputs in = tick(i);
    controller.step(in, got);
    unit.step(self, &in, &want);
    ASSERT_TRUE(same_answers(got, want)) << i;
  }
  unit.destroy(self);
}

// A fault keeps its state in its instance: a second instance starts anew.
TEST(FaultyController, InstancesShareNothing) {
  for (const Fault* fault : catalogue()) {
    const Fault* const one[] = {fault};
    FaultyController first(Profile::px4_v1_5_5, one);
    const attest_outputs once = flown(first);
    flown(first);
    FaultyController second(Profile::px4_v1_5_5, one);
    const attest_outputs again = flown(second);
    EXPECT_TRUE(same_answers(once, again)) << fault->id;
  }
}

// Each changes the stage that it finds, so both act, also in one stage.
TEST(FaultyController, TwoFaultsOfOneStageActTogether) {
  const auto may_integrate = [](std::initializer_list<const char*> ids, float thrust, bool upper) {
    std::vector<const Fault*> faults;
    for (const char* id : ids) faults.push_back(find_fault(id));
    return law_with(faults).rate.may_integrate(thrust, {.lower = false, .upper = upper});
  };
  const auto both = {"gate-takeoff-dropped", "gate-upper-dropped"};
  EXPECT_FALSE(may_integrate({"gate-takeoff-dropped"}, 0.1f, true));
  EXPECT_FALSE(may_integrate({"gate-upper-dropped"}, 0.1f, true));
  EXPECT_TRUE(may_integrate(both, 0.1f, true));

  const Fault* const signs[] = {find_fault("i-subtracted"), find_fault("d-missing")};
  const Vector one = Vector::Ones(), two = 2 * one, three = 3 * one, four = 4 * one;
  EXPECT_EQ(law_with(signs).rate.control(one, two, three, four), Vector(one - three + four));

  const Fault* const gains[] = {find_fault("pitch-p-of-roll"), find_fault("yaw-p-of-roll")};
  Parameters parameters = mc_att_control::default_parameters();
  parameters.mc_roll_p = 3.0f;
  const AttitudeGains attitude = law_with(gains).step.gains(parameters).attitude;
  EXPECT_EQ(attitude.proportional_1_s, Vector::Constant(3.0f));
}

TEST(FaultyController, TwoFaultsActTogether) {
  const Fault* const both[] = {find_fault("thrust-negated"), find_fault("gear-missing")};
  FaultyController controller(Profile::px4_v1_5_5, both);
  const attest_outputs out = flown(controller);
  EXPECT_EQ(out.actuator_controls_0.control[3], -0.6f);
  EXPECT_EQ(out.actuator_controls_0.control[7], 0);
}

}  // namespace
}  // namespace attest::faults
