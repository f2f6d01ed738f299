#include "harness/diagnosis/diagnose_catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/verify/small_suite.hpp"

namespace attest {
namespace {

constexpr const char* newest = "px4-v1.5.5";

// Cases of 20 ms, so the number of ticks gives the rate: 2 at 100 Hz, 5 at 250 Hz, 20 at 1 kHz.
class Cases {
 public:
  void add(std::string_view name, std::string_view body, std::vector<int> rates_hz) {
    suite_.add_unblessed(name, body);
    SelectedCase one{suite_[cases_.size()], {}};
    one.the_case.duration = {0.02, Span::In::seconds};
    for (const int hz : rates_hz) one.configurations.push_back({Rate::hz(hz), std::nullopt});
    cases_.push_back(std::move(one));
  }
  operator const std::vector<SelectedCase>&() const { return cases_; }

 private:
  SmallSuite suite_;
  std::vector<SelectedCase> cases_;
};

const char* const attenuated =
    "[parameters]\nMC_TPA_BREAK = 0.3\n[control_state]\nroll_rate = 0.3\n"
    "[vehicle_attitude_setpoint]\nthrust = 0.8\n";

SelfDiagnosis of(const char* fault, const std::vector<SelfDiagnosis>& results) {
  for (const SelfDiagnosis& result : results) {
    if (result.fault->id == fault) return result;
  }
  ADD_FAILURE() << fault << " was not diagnosed";
  return {};
}

TEST(DiagnoseCatalogue, EachFaultThatTheProfileCanTellIsDiagnosedInOrder) {
  std::vector<const faults::Fault*> expected, diagnosed;
  for (const faults::Fault* fault : faults::catalogue()) {
    if (fault->is_detectable(newest)) expected.push_back(fault);
  }
  for (const SelfDiagnosis& result : diagnose_catalogue({}, newest)) {
    diagnosed.push_back(result.fault);
    EXPECT_FALSE(result.diagnosis) << "no vector tells it from the law";
  }
  EXPECT_EQ(diagnosed, expected);
}

TEST(DiagnoseCatalogue, AFaultIsNamedByTheCaseThatShowsIt) {
  Cases cases;
  cases.add("level", "", {250});
  cases.add("loud", attenuated, {250});
  const auto results = diagnose_catalogue(cases, newest);
  const SelfDiagnosis shown = of("tpa-missing", results);
  EXPECT_TRUE(shown.is_named());
  EXPECT_TRUE(shown.is_stage_named());
  ASSERT_TRUE(shown.diagnosis);
  EXPECT_EQ(shown.diagnosis->vectors, 2u);
  EXPECT_EQ(shown.diagnosis->failing, 1u);
  const SelfDiagnosis hidden = of("yaw-reversed", results);
  EXPECT_FALSE(hidden.diagnosis);
  EXPECT_FALSE(hidden.is_named());
  EXPECT_FALSE(hidden.is_stage_named());
}

TEST(DiagnoseCatalogue, ACaseIsOneVectorAtOneOfItsRates) {
  for (const std::vector<int>& rates : {std::vector<int>{100, 250, 1000}, {250, 1000}, {1000}}) {
    Cases cases;
    cases.add("loud", attenuated, rates);
    const auto diagnosis = of("tpa-missing", diagnose_catalogue(cases, newest)).diagnosis;
    ASSERT_TRUE(diagnosis);
    EXPECT_EQ(diagnosis->vectors, 1u);
  }
}

// ---- what is named ------------------------------------------------------------------------------

const char* const the_fault = "yaw-weight-dropped";
const char* const another = "tpa-missing";
const char* const a_third = "tilt-in-world";

Suspect suspect(const char* first, const std::vector<const char*>& others = {}) {
  Suspect one;
  one.fault = faults::find_fault(first);
  for (const char* const id : others) one.ambiguity_group.push_back(faults::find_fault(id));
  return one;
}

SelfDiagnosis diagnosed(const char* fault, std::vector<Suspect> suspects) {
  SelfDiagnosis self{faults::find_fault(fault), Diagnosis(), {}};
  self.diagnosis->suspects = std::move(suspects);
  self.diagnosis->stage = faults::Stage::yaw;
  return self;
}

SelfDiagnosis not_diagnosed(const char* fault) {
  return {faults::find_fault(fault), std::nullopt, {}};
}

TEST(SelfDiagnosis, AFaultIsNamedWhenItIsFirstOrAsGoodAsTheFirst) {
  EXPECT_TRUE(diagnosed(the_fault, {suspect(the_fault, {another}), suspect(a_third)}).is_named());
  EXPECT_TRUE(diagnosed(the_fault, {suspect(another, {a_third, the_fault})}).is_named());
}

TEST(SelfDiagnosis, AFaultThatIsSecondOrLeftOutIsNotNamed) {
  EXPECT_FALSE(diagnosed(the_fault, {suspect(another, {a_third}), suspect(the_fault)}).is_named());
  EXPECT_FALSE(diagnosed(the_fault, {suspect(another), suspect(a_third, {the_fault})}).is_named());
  EXPECT_FALSE(diagnosed(the_fault, {}).is_named());
  EXPECT_FALSE(not_diagnosed(the_fault).is_named());
}

TEST(SelfDiagnosis, TheStageIsNamedWhenItIsThatOfTheFault) {
  EXPECT_TRUE(diagnosed(the_fault, {}).is_stage_named());
  EXPECT_FALSE(diagnosed(another, {}).is_stage_named());
  EXPECT_FALSE(not_diagnosed(the_fault).is_stage_named());
}

TEST(StageLine, IsTheFaultsOwnStageIfThatHasOutputs) {
  using In = faults::Stage;
  EXPECT_EQ(stage_line(In::yaw, only(Stage::attitude_law)), StageLine::own);
  EXPECT_EQ(stage_line(In::yaw, only(Stage::sticks) | only(Stage::attitude_law)), StageLine::own);
  EXPECT_EQ(stage_line(In::sticks, only(Stage::attitude_law)), StageLine::wrong);
  EXPECT_EQ(stage_line(In::timing, only(Stage::rate_law)), StageLine::later);
}

TEST(StageLine, OfAFaultIsThatOfMostOfItsVectors) {
  SelfDiagnosis self = not_diagnosed(the_fault);
  self.stage_lines = {StageLine::own, StageLine::wrong, StageLine::own};
  EXPECT_EQ(self.usual_stage_line(), StageLine::own);
  self.stage_lines.push_back(StageLine::wrong);
  EXPECT_EQ(self.usual_stage_line(), StageLine::wrong);
}

TEST(DiagnoseCatalogue, HasTheStageLineOfEachFailingVector) {
  Cases cases;
  cases.add("level", "", {250});
  cases.add("loud", attenuated, {250});
  const auto results = diagnose_catalogue(cases, newest);
  EXPECT_THAT(of("tpa-missing", results).stage_lines, testing::ElementsAre(StageLine::own));
  EXPECT_THAT(of("yaw-reversed", results).stage_lines, testing::IsEmpty());
}

}  // namespace
}  // namespace attest
