#include "harness/loop/open_loop.hpp"

#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/loop/numbered_trace.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Kind = PortFault::Kind;

// Runs the step that the test gives, and records the calls.
class FakeUnit final : public UnitOf<attest_inputs, attest_outputs> {
 public:
  using Step = std::function<int(const attest_inputs&, attest_outputs&)>;
  explicit FakeUnit(Step step = [](const auto&, auto&) { return ATTEST_OK; })
      : step_(std::move(step)) {}

  int set_parameter(const std::string& name, float value) override {
    calls.push_back(fmt::format("{}={}", name, value));
    return name == "BAD" ? bad_parameter : ATTEST_OK;
  }
  int step(const attest_inputs& in, attest_outputs& out) override {
    calls.push_back(fmt::format("step {}", in.timestamp));
    return step_(in, out);
  }

  std::vector<std::string> calls;
  int bad_parameter = ATTEST_INVALID;

 private:
  Step step_;
};

// The fault of a unit whose step at tick 1 returns `code`.
std::optional<PortFault> fault_of_code(int code) {
  FakeUnit unit(
      [&](const attest_inputs& in, auto&) { return in.timestamp == 1 ? code : ATTEST_OK; });
  Trace trace = trace_of(3);
  return drive(unit, trace);
}

TEST(Drive, SetsParametersBeforeTheStepOfTheirTick) {
  FakeUnit unit;
  Trace trace = trace_of(3);
  trace.parameters = {{0, "A", 1}, {0, "B", 2}, {2, "A", 3}};
  EXPECT_FALSE(drive(unit, trace));
  EXPECT_THAT(unit.calls, ElementsAre("A=1", "B=2", "step 0", "step 1", "A=3", "step 2"));
}

TEST(Drive, GivesEachStepTheOutputsOfTheOneBefore) {
  FakeUnit unit([](const attest_inputs& in, attest_outputs& out) {
    EXPECT_EQ(out.actuator_controls_0.control[0], static_cast<float>(in.timestamp));
    out.actuator_controls_0.control[0] += 1;
    return ATTEST_OK;
  });
  Trace trace = trace_of(3);
  // Outputs that the trace already has are replaced; the first step does not start from them.
  for (Sample& sample : trace.samples) sample.out.actuator_controls_0.control[0] = 99;
  EXPECT_FALSE(drive(unit, trace));
  EXPECT_EQ(trace.samples[0].out.actuator_controls_0.control[0], 1);
  EXPECT_EQ(trace.samples[2].out.actuator_controls_0.control[0], 3);
}

TEST(Drive, ATraceWithoutTicksIsNothingToDo) {
  FakeUnit unit;
  Trace trace;
  EXPECT_FALSE(drive(unit, trace));
  EXPECT_THAT(unit.calls, IsEmpty());
}

TEST(Drive, SaysWhatTheStepReturned) {
  EXPECT_FALSE(fault_of_code(ATTEST_OK));
  const auto unsupported = fault_of_code(ATTEST_UNSUPPORTED);
  ASSERT_TRUE(unsupported);
  EXPECT_EQ(unsupported->kind, Kind::unsupported);
  EXPECT_EQ(unsupported->tick, 1u);
  EXPECT_EQ(unsupported->what, "step at tick 1 returned ATTEST_UNSUPPORTED");
  EXPECT_EQ(fault_of_code(ATTEST_FAILED)->kind, Kind::failed);
  EXPECT_EQ(fault_of_code(ATTEST_INVALID)->kind, Kind::failed);
  EXPECT_THAT(fault_of_code(ATTEST_INVALID)->what, HasSubstr("ATTEST_INVALID"));
}

TEST(Drive, AnotherResultBreaksTheRules) {
  for (const int code : {-1, 4, 1000}) {
    const auto fault = fault_of_code(code);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->kind, Kind::protocol);
    EXPECT_THAT(fault->what, HasSubstr(fmt::format("returned {}, which is no ATTEST_", code)));
  }
}

TEST(Drive, SaysWhichParameterWasRefused) {
  FakeUnit unit;
  Trace trace = trace_of(3);
  trace.parameters = {{0, "GOOD", 1}, {2, "BAD", 2}};
  const auto fault = drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::refused);
  EXPECT_EQ(fault->tick, 2u);
  EXPECT_EQ(fault->what, "set_parameter(BAD) at tick 2 returned ATTEST_INVALID");
  unit.bad_parameter = ATTEST_UNSUPPORTED;
  EXPECT_EQ(drive(unit, trace)->kind, Kind::unsupported);
}

TEST(Drive, StopsAtTheFaultAndKeepsWhatWasBefore) {
  FakeUnit unit([](const attest_inputs& in, attest_outputs& out) {
    out.actuator_controls_0.control[0] = 5;
    return in.timestamp == 1 ? ATTEST_FAILED : ATTEST_OK;
  });
  Trace trace = trace_of(3);
  EXPECT_TRUE(drive(unit, trace));
  EXPECT_THAT(unit.calls, ElementsAre("step 0", "step 1"));
  EXPECT_EQ(trace.samples[0].out.actuator_controls_0.control[0], 5);
  EXPECT_EQ(trace.samples[1].out.actuator_controls_0.control[0], 0);
}

TEST(Drive, AnAnswerThatBreaksTheProtocolIsAFaultOfItsTick) {
  FakeUnit unit([](const attest_inputs& in, auto&) {
    if (in.timestamp == 2) throw PortBroke(PortBroke::How::rules, "the answer is no frame");
    return ATTEST_OK;
  });
  Trace trace = trace_of(4);
  const auto fault = drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::protocol);
  EXPECT_EQ(fault->tick, 2u);
  EXPECT_EQ(fault->what, "at tick 2: the answer is no frame");
}

TEST(Drive, InputsAreConst) {
  FakeUnit unit([](const attest_inputs& in, auto&) {
    if (in.timestamp == 1) const_cast<attest_inputs&>(in).battery_status.scale = 2;
    return ATTEST_OK;
  });
  Trace trace = trace_of(3);
  const auto fault = drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::protocol);
  EXPECT_EQ(fault->what, "step changed its inputs at tick 1; they are const");
}

// Runs the step that the test gives.
class FakeMixer final : public UnitOf<attest_mixer_inputs, attest_mixer_outputs> {
 public:
  using Step = std::function<int(const attest_mixer_inputs&, attest_mixer_outputs&)>;
  explicit FakeMixer(Step step) : step_(std::move(step)) {}
  int set_parameter(const std::string&, float) override { return ATTEST_INVALID; }
  int step(const attest_mixer_inputs& in, attest_mixer_outputs& out) override {
    return step_(in, out);
  }

 private:
  Step step_;
};

class FakePort final : public Port {
 public:
  explicit FakePort(FakeMixer::Step step) : step_(std::move(step)) {}
  std::string name() const override { return "fake"; }
  std::string version() const override { return "1"; }
  ModuleSet modules() const override { return only(Module::mc_att_control) | only(Module::mixer); }
  std::unique_ptr<Unit> create_unit(Module module, const std::string& profile,
                                    const std::string& definition) override {
    if (profile != "known" || module != Module::mixer) return nullptr;
    asked_for = definition;
    return std::make_unique<FakeMixer>(step_);
  }

  std::string asked_for;

 private:
  FakeMixer::Step step_;
};

TEST(DriveAPart, GivesAMixerItsInputsAndRecordsItsOutputs) {
  FakePort port([](const attest_mixer_inputs& in, attest_mixer_outputs& out) {
    out.actuator_outputs.output[2] += in.actuator_controls_0.control[1];
    return ATTEST_OK;
  });
  Trace trace = trace_of(3);
  for (Sample& sample : trace.samples) sample.mixer_in.actuator_controls_0.control[1] = 0.25f;
  EXPECT_FALSE(drive(port, {"known", Module::mixer, "R: 4x 1 1 1 0"}, trace));
  EXPECT_EQ(port.asked_for, "R: 4x 1 1 1 0");
  EXPECT_EQ(trace.samples[2].mixer_out.actuator_outputs.output[2], 0.75f);
}

TEST(DriveAPart, WhatThePortDoesNotHaveIsUnsupported) {
  FakePort port([](const auto&, auto&) { return ATTEST_OK; });
  Trace trace = trace_of(1);
  const auto without = drive(port, {"known", Module::battery_status}, trace);
  ASSERT_TRUE(without);
  EXPECT_EQ(without->kind, Kind::module);
  EXPECT_THAT(without->what, HasSubstr("attest.battery_status.v1"));
  const auto unknown = drive(port, {"unknown", Module::mixer, "R: 4x 1 1 1 0"}, trace);
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->kind, Kind::unsupported);
  EXPECT_THAT(unknown->what, HasSubstr("no mixer `R: 4x 1 1 1 0` of profile unknown"));
  EXPECT_EQ(drive(port, {"known"}, trace)->kind, Kind::profile);
}

TEST(DriveAPart, WritingBehindItsOutputsIsSeen) {
  FakePort port([](const attest_mixer_inputs&, attest_mixer_outputs& out) {
    unsigned char* volatile place = reinterpret_cast<unsigned char*>(&out) + sizeof out;
    *place = 0;
    return ATTEST_OK;
  });
  Trace trace = trace_of(1);
  const auto fault = drive(port, {"known", Module::mixer}, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::protocol);
}

TEST(Drive, OneByteBehindTheStructsIsSeen) {
  for (const bool behind_inputs : {false, true}) {
    FakeUnit unit([&](const attest_inputs& in, attest_outputs& out) {
      auto* const end =
          behind_inputs
              ? reinterpret_cast<unsigned char*>(&const_cast<attest_inputs&>(in)) + sizeof in
              : reinterpret_cast<unsigned char*>(&out) + sizeof out;
      // Through volatile, because the compiler could see that the write is outside the struct.
      unsigned char* volatile place = end;
      *place = 0;
      return ATTEST_OK;
    });
    Trace trace = trace_of(1);
    const auto fault = drive(unit, trace);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->kind, Kind::protocol);
    EXPECT_THAT(fault->what, HasSubstr("wrote outside its outputs at tick 0"));
  }
}

}  // namespace
}  // namespace attest
