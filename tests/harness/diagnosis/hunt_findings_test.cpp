#include "harness/diagnosis/hunt_findings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/diagnosis/hunted.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::UnorderedElementsAre;

TEST(HuntFindings, FindingsOfOneCauseAreOneFinding) {
  const HuntRun run =
      found_by(hunted({{"px4-v1.16.0", Module::rate_unit}, {"px4-v1.15.4", Module::rate_unit}}),
               fault_host("cascade-d-reversed"));
  ASSERT_THAT(names_of(run), ElementsAre("cascade_d_reversed"));
  const HuntFinding& finding = run.findings.front();
  EXPECT_GT(finding.trials, 3u);
  EXPECT_LT(finding.trace.samples.size(), 8u);
  // The port's answers end at the first deviation.
  ASSERT_TRUE(finding.failure.first);
  ASSERT_THAT(finding.got.samples, SizeIs(finding.failure.first->tick + 1));
  EXPECT_EQ(value_of(channels()[finding.failure.first->channel], finding.got.samples.back()),
            finding.failure.first->got);
  EXPECT_EQ(finding.failure.verdict, Verdict::fail);
  EXPECT_THAT(finding.toml, HasSubstr("Fill in"));
}

TEST(HuntFindings, TwoMistakesAreTwoFindings) {
  const HuntRun run =
      found_by(hunted({{"px4-v1.16.0", Module::rate_unit}, {"px4-v1.16.0", Module::attitude_unit}}),
               fault_host("cascade-m-not-canonical+cascade-d-reversed"));
  EXPECT_THAT(names_of(run), UnorderedElementsAre("cascade_d_reversed", "cascade_m_not_canonical"));
}

// If several faults fit, each of their names is a guess.
TEST(HuntFindings, AFindingThatSeveralFaultsFitHasNoFault) {
  HuntFinding finding;
  EXPECT_EQ(fault_of(finding), nullptr);
  EXPECT_EQ(fitting_faults(finding), 0u);
  finding.suspect = Suspect{faults::find_fault("cascade-d-reversed"), 2, 2, {}, 0};
  EXPECT_EQ(fault_of(finding), finding.suspect->fault);
  finding.suspect->others = 1;
  EXPECT_EQ(fault_of(finding), nullptr);
  EXPECT_EQ(fitting_faults(finding), 2u);
}

// The failing trials of one mistake fail in several outputs and profiles. Each of them alone fits
// other faults, too.
TEST(HuntFindings, AMistakeHasOneFindingWithItsName) {
  for (const char* fault : {"cascade-i-without-dt", "cascade-rate-p-exchanged",
                            "cascade-integral-on-the-ground", "cascade-torque-axes-exchanged"}) {
    const HuntRun run =
        found_by(hunted({{"px4-v1.16.0", Module::rate_unit}, {"px4-v1.17", Module::rate_unit}}),
                 fault_host(fault));
    ASSERT_THAT(run.findings, SizeIs(1)) << fault;
    ASSERT_TRUE(run.findings[0].suspect) << fault;
    EXPECT_EQ(run.findings[0].suspect->fault->id, fault);
    EXPECT_NE(fault_of(run.findings[0]), nullptr) << fault;
  }
}

// No fault gives these values. The finding has the stage and the topic, not the axis.
TEST(HuntFindings, AMistakeThatNoFaultGivesIsOneFinding) {
  const HuntRun run = found_by(of_rate_unit(), changed_host([](const ModuleUnderTest&, Trace& t) {
                                 for (Sample& sample : t.samples) {
                                   for (float& x : sample.rate_out.vehicle_torque_setpoint.xyz)
                                     x *= 1.1F;
                                 }
                                 return std::optional<PortFault>();
                               }));
  EXPECT_THAT(names_of(run), ElementsAre("rate_law_vehicle_torque_setpoint"));
  EXPECT_THAT(run.findings.at(0).pattern, HasSubstr("are 1.1 times those expected"));
}

}  // namespace
}  // namespace attest
