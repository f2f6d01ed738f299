#include "harness/diagnosis/naive_suite.hpp"

#include <array>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/port/builtin.hpp"
#include "harness/port/fault_port.hpp"

namespace attest {
namespace {

using testing::Each;
using testing::SizeIs;

const char* const the_profile = "px4-v1.5.5";

// Changes the outputs of a step, counted from 0; returns ATTEST_OK or another result.
using Change = std::function<int(std::size_t step, attest_outputs& out)>;

// The reference, with its outputs changed.
class ChangedUnit final : public UnitOf<attest_inputs, attest_outputs> {
 public:
  ChangedUnit(std::unique_ptr<Unit> law, Change change, std::vector<attest_inputs>& given)
      : law_(std::move(law)), change_(std::move(change)), given_(given) {}

  int set_parameter(const std::string& name, float value) override {
    return law_->set_parameter(name, value);
  }
  int step(const attest_inputs& in, attest_outputs& out) override {
    law_->step(in, out);
    given_.push_back(in);
    return change_(given_.size() - 1, out);
  }

 private:
  std::unique_ptr<Unit> law_;
  Change change_;
  std::vector<attest_inputs>& given_;
};

class ChangedPort final : public Port {
 public:
  explicit ChangedPort(Change change) : change_(std::move(change)) {}

  std::string name() const override { return "changed"; }
  std::string version() const override { return "1"; }
  std::unique_ptr<Unit> create_unit(Module, const std::string& profile,
                                    const std::string&) override {
    return std::make_unique<ChangedUnit>(reference_->create(profile), change_, given);
  }

  std::vector<attest_inputs> given;

 private:
  std::unique_ptr<Port> reference_ = open_builtin();
  Change change_;
};

int changes_nothing(std::size_t, attest_outputs&) { return ATTEST_OK; }

bool hover_catches(Change change) {
  ChangedPort port(std::move(change));
  return caught_by_hover(port, the_profile);
}

bool random_attitudes_catch(Change change) {
  ChangedPort port(std::move(change));
  return caught_by_random_attitudes(port, the_profile);
}

// Which of the two suites catches a fault of the catalogue.
struct Caught {
  bool by_hover, by_random_attitudes;
  friend bool operator==(const Caught&, const Caught&) = default;
};
Caught caught(const char* fault) {
  const auto port = open_fault(fault);
  return {caught_by_hover(**port, the_profile), caught_by_random_attitudes(**port, the_profile)};
}

// The tilts [deg] of the state and of the setpoint.
std::pair<double, double> tilts_deg(const attest_inputs& in) {
  const auto tilt = [](const float(&q)[4]) {
    return std::acos(1 - 2 * static_cast<double>(q[1] * q[1] + q[2] * q[2])) * 180 / std::acos(-1);
  };
  return {tilt(in.control_state.q), tilt(in.vehicle_attitude_setpoint.q_d)};
}

TEST(NaiveSuite, TheLawIsNotCaught) {
  EXPECT_FALSE(hover_catches(changes_nothing));
  EXPECT_FALSE(random_attitudes_catch(changes_nothing));
}

TEST(NaiveSuite, HoverIsTenSecondsAt250HzNearlyLevelWithTheSticksCentred) {
  ChangedPort port(changes_nothing);
  caught_by_hover(port, the_profile);
  ASSERT_THAT(port.given, SizeIs(2500));
  for (std::size_t i = 0; i < port.given.size(); ++i) {
    const attest_inputs& in = port.given[i];
    EXPECT_EQ(in.timestamp - port.given[0].timestamp, 4000 * i);
    EXPECT_LT(tilts_deg(in).first, 10);
    EXPECT_LT(tilts_deg(in).second, 10);
    const auto& sticks = in.manual_control_setpoint;
    EXPECT_THAT((std::array{sticks.x, sticks.y, sticks.r}), Each(0.0f));
  }
}

TEST(NaiveSuite, RandomAttitudesAreAThousandPairsOfAnyTwo) {
  ChangedPort port(changes_nothing);
  caught_by_random_attitudes(port, the_profile);
  ASSERT_THAT(port.given, SizeIs(1000));
  std::size_t state_inverted = 0, setpoint_inverted = 0;
  for (const attest_inputs& in : port.given) {
    const auto [of_state, of_setpoint] = tilts_deg(in);
    state_inverted += of_state > 90 ? 1 : 0;
    setpoint_inverted += of_setpoint > 90 ? 1 : 0;
  }
  // Half of them, give or take six standard deviations.
  for (const std::size_t inverted : {state_inverted, setpoint_inverted}) {
    EXPECT_GT(inverted, 400u);
    EXPECT_LT(inverted, 600u);
  }
}

TEST(NaiveSuite, APortThatGoesWrongIsCaughtAtAnyStep) {
  for (const int result : std::vector<int>{ATTEST_FAILED, ATTEST_INVALID, 99}) {
    for (const std::size_t step : {0u, 999u}) {
      const Change fails = [=](std::size_t at, auto&) { return at == step ? result : ATTEST_OK; };
      EXPECT_TRUE(hover_catches(fails)) << result << " at " << step;
      EXPECT_TRUE(random_attitudes_catch(fails)) << result << " at " << step;
    }
  }
}

TEST(NaiveSuite, AWrongRateSetpointAtAnyStepIsCaught) {
  for (const std::size_t step : {0u, 500u, 999u}) {
    const Change rolls = [step](std::size_t at, attest_outputs& out) {
      if (at == step) out.vehicle_rates_setpoint.roll += 0.01f;
      return ATTEST_OK;
    };
    EXPECT_TRUE(hover_catches(rolls)) << step;
    EXPECT_TRUE(random_attitudes_catch(rolls)) << step;
  }
}

TEST(NaiveSuite, TheLastStepOfHoverCounts) {
  EXPECT_TRUE(hover_catches([](std::size_t at, attest_outputs& out) {
    if (at == 2499) out.actuator_controls_0.control[0] += 0.01f;
    return ATTEST_OK;
  }));
}

TEST(NaiveSuite, RandomAttitudesSeeTheRatesSetpointOnly) {
  const Change controls = [](std::size_t, attest_outputs& out) {
    out.actuator_controls_0.control[0] += 0.01f;
    out.mc_att_ctrl_status.yaw_rate_integ += 0.01f;
    return ATTEST_OK;
  };
  EXPECT_TRUE(hover_catches(controls));
  EXPECT_FALSE(random_attitudes_catch(controls));
}

TEST(NaiveSuite, WhatTheNumericLevelAllowsIsNotCaught) {
  const Change rounds = [](std::size_t, attest_outputs& out) {
    out.vehicle_rates_setpoint.roll += 1e-4f;
    out.actuator_controls_0.control[0] += 5e-5f;
    return ATTEST_OK;
  };
  EXPECT_FALSE(hover_catches(rounds));
  EXPECT_FALSE(random_attitudes_catch(rounds));
}

TEST(NaiveSuite, EachCatchesWhatItsInputsShow) {
  EXPECT_EQ(caught("p-missing"), (Caught{true, false}));
  EXPECT_EQ(caught("limit-missing"), (Caught{false, true}));
  EXPECT_EQ(caught("yaw-reversed"), (Caught{false, true})) << "it has no yaw error";
  EXPECT_EQ(caught("tilt-cross-reversed"), (Caught{true, true}));
  EXPECT_EQ(caught("tpa-missing"), (Caught{false, false})) << "no thrust is above the break";
}

}  // namespace
}  // namespace attest
