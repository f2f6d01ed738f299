#include "harness/verify/silent_topics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/verify/declared_lacks.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Three ticks of the rate unit that publish torque, thrust and the integrals at the last two.
Trace publishing() {
  Trace trace;
  trace.present = channels_of(Module::rate_unit);
  trace.samples.resize(3);
  for (std::size_t tick = 0; tick < 3; ++tick) {
    Sample& sample = trace.samples[tick];
    sample.in.timestamp = 1000 * tick;
    const auto flag = static_cast<std::uint8_t>(tick > 0);
    sample.rate_out.vehicle_torque_setpoint.published = flag;
    sample.rate_out.vehicle_thrust_setpoint.published = flag;
    sample.rate_out.rate_ctrl_status.published = flag;
  }
  return trace;
}

Trace without_integrals() {
  Trace trace = publishing();
  for (Sample& sample : trace.samples) sample.rate_out.rate_ctrl_status.published = 0;
  return trace;
}

VectorResult judged(const Trace& got, const ChannelSet& lacks = {}) {
  VectorResult result;
  result.profile = "px4-v1.16.0";
  silent_outputs(got, publishing(), lacks, result);
  return result;
}

TEST(SilentTopics, AreThoseThatOnlyTheGoldenPublishes) {
  const VectorResult result = judged(without_integrals());
  EXPECT_THAT(result.silent, ElementsAre("rate_unit/rate_ctrl_status"));
  EXPECT_THAT(result.published, ElementsAre("rate_unit/vehicle_torque_setpoint",
                                            "rate_unit/vehicle_thrust_setpoint"));
  ASSERT_TRUE(result.first_silence);
  EXPECT_EQ(result.first_silence->tick, 1u);
  EXPECT_EQ(result.first_silence->timestamp_us, 1000u);
  EXPECT_THAT(judged(publishing()).silent, IsEmpty());
}

// Otherwise a port that publishes nothing would pass.
TEST(SilentTopics, AreNoneIfNothingElseIsLeftToCompare) {
  Trace nothing = publishing();
  for (Sample& sample : nothing.samples) sample.clear_outputs();
  EXPECT_THAT(judged(nothing).silent, IsEmpty());
}

TEST(SilentTopics, AreNotThoseThatThePortDeclaresToLack) {
  const auto lacks = Lacks::parse(std::vector<std::string>{"rate_ctrl_status"});
  ASSERT_TRUE(lacks);
  EXPECT_THAT(judged(without_integrals(), lacks->outputs).silent, IsEmpty());
}

// The traces of a flight's units are judged one after the other.
TEST(SilentTopics, OfOneUnitStayWhenTheOtherPublishesAll) {
  VectorResult result = judged(without_integrals());
  silent_outputs(publishing(), publishing(), {}, result);
  EXPECT_THAT(result.silent, ElementsAre("rate_unit/rate_ctrl_status"));
  ASSERT_TRUE(result.first_silence);
  EXPECT_EQ(result.silent_ticks, 2u);
}

TEST(SilentTopics, AreOneFailureIfNoVectorHasThem) {
  std::vector<VectorResult> results(3, judged(without_integrals()));
  results.front().verdict = Verdict::unsupported;
  settle_silent_topics(results);
  EXPECT_EQ(results[0].verdict, Verdict::unsupported);
  EXPECT_EQ(results[1].verdict, Verdict::fail);
  EXPECT_THAT(results[1].reason, HasSubstr("the port never publishes rate_ctrl_status"));
  ASSERT_TRUE(results[1].first);
  EXPECT_EQ(channels()[results[1].first->channel].name, "out/rate_ctrl_status.published");
  EXPECT_EQ(results[2].verdict, Verdict::pass);
  EXPECT_FALSE(results[2].first);
}

TEST(SilentTopics, AreOneFailureOfEachProfile) {
  std::vector<VectorResult> results(4, judged(without_integrals()));
  results[2].profile = results[3].profile = "px4-v1.18";
  settle_silent_topics(results);
  EXPECT_EQ(results[0].verdict, Verdict::fail);
  EXPECT_EQ(results[1].verdict, Verdict::pass);
  EXPECT_EQ(results[2].verdict, Verdict::fail);
  EXPECT_EQ(results[3].verdict, Verdict::pass);
  EXPECT_EQ(results[0].deviating_ticks, 2u);
}

// Otherwise one expected failure would excuse the topic in all vectors.
TEST(SilentTopics, FailInOneMoreVectorIfTheFirstIsExcused) {
  std::vector<VectorResult> results(3, judged(without_integrals()));
  results[0].name = "excused";
  settle_silent_topics(results, [](const VectorResult& one) {
    return one.name == "excused" && one.verdict == Verdict::fail;
  });
  EXPECT_EQ(results[0].verdict, Verdict::fail);
  EXPECT_EQ(results[1].verdict, Verdict::fail);
  EXPECT_EQ(results[2].verdict, Verdict::pass);
}

TEST(SilentTopics, OfTheDiagnosisAreThoseThatNoVectorHas) {
  std::vector<VectorResult> results(1, judged(without_integrals()));
  EXPECT_EQ(never_published_outputs(results),
            channels_of(Module::rate_unit, "out/rate_ctrl_status."));
  results.push_back(judged(publishing()));
  EXPECT_TRUE(never_published_outputs(results).none());
}

TEST(SilentTopics, AreFailuresIfAnotherVectorHasThem) {
  std::vector<VectorResult> results(2, judged(without_integrals()));
  results.push_back(judged(publishing()));
  settle_silent_topics(results);
  EXPECT_EQ(results[0].verdict, Verdict::fail);
  EXPECT_EQ(results[1].verdict, Verdict::fail);
  EXPECT_EQ(results[1].reason, "rate_ctrl_status is published at no tick");
  EXPECT_EQ(results[2].verdict, Verdict::pass);
}

VectorResult left_out_for(std::vector<Feature> features, Verdict verdict) {
  FeatureSet lacking;
  for (const Feature feature : features) lacking |= only(feature);
  VectorResult result;
  result.verdict = verdict;
  result.deviating_ticks = verdict == Verdict::pass ? 0 : 3;
  leave_out(lacking, result);
  return result;
}

TEST(DeclaredLacks, LeaveOutAVectorWhateverItsVerdict) {
  for (const Verdict verdict : {Verdict::pass, Verdict::fail, Verdict::crash}) {
    const VectorResult result = left_out_for({Feature::sticks, Feature::battery}, verdict);
    EXPECT_EQ(result.verdict, Verdict::unsupported);
    EXPECT_EQ(result.reason, "the port declares that it lacks sticks, battery");
    EXPECT_EQ(result.deviating_ticks, 0u);
  }
  EXPECT_EQ(left_out_for({}, Verdict::fail).verdict, Verdict::fail);
}

// A vector that uses two of them passes perhaps because of what the other one does.
TEST(DeclaredLacks, AreNeedlessIfAllVectorsThatUseOnlyOnePass) {
  const VectorResult passes = left_out_for({Feature::sticks}, Verdict::pass);
  const VectorResult fails = left_out_for({Feature::sticks}, Verdict::fail);
  const VectorResult of_two = left_out_for({Feature::sticks, Feature::tpa}, Verdict::pass);
  EXPECT_THAT(needless_lacks({passes, of_two}), ElementsAre("sticks"));
  EXPECT_THAT(needless_lacks({passes, fails}), IsEmpty());
  EXPECT_THAT(needless_lacks({of_two}), IsEmpty());
}

TEST(DeclaredLacks, OfATopicThatIsPublishedAreNeedless) {
  const auto lacks = Lacks::parse(std::vector<std::string>{"rate_ctrl_status"});
  ASSERT_TRUE(lacks);
  VectorResult has, has_not;
  note_published(*lacks, publishing(), has);
  note_published(*lacks, without_integrals(), has_not);
  EXPECT_THAT(needless_lacks({has_not, has}), ElementsAre("rate_ctrl_status"));
  EXPECT_THAT(needless_lacks({has_not}), IsEmpty());
}

TEST(DeclaredLacks, OfASecondInstanceConcernTheCasesThatNeedOne) {
  const auto lacks = Lacks::parse(std::vector<std::string>{"instances"});
  ASSERT_TRUE(lacks);
  ModuleUnderTest subject{"px4-v1.16.0", Module::rate_unit};
  EXPECT_TRUE(lacking_features(*lacks, publishing(), subject).none());
  subject.instances = Instances::together;
  EXPECT_THAT(names_of(lacking_features(*lacks, publishing(), subject)), ElementsAre("instances"));
}

TEST(DeclaredLacks, OfConstantsChangeTheParametersThatTheVectorDoesNotSet) {
  const auto lacks =
      Lacks::parse(std::vector<std::string>{"MC_ROLLRATE_P=0.2", "MC_ROLLRATE_I=0.2"});
  ASSERT_TRUE(lacks);
  const ModuleUnderTest subject{"px4-v1.16.0", Module::rate_unit};
  std::vector<ParameterChange> parameters;
  VectorResult result;
  Trace inputs = publishing();
  EXPECT_TRUE(adds_constants(*lacks, subject, inputs, parameters, result));
  EXPECT_THAT(parameters, ElementsAre(ParameterChange{0, "MC_ROLLRATE_P", 0.2f}));

  // Until the case sets it, the port has its constant, too.
  parameters.clear();
  inputs.parameters = {{2, "MC_ROLLRATE_P", 0.2f}};
  EXPECT_TRUE(adds_constants(*lacks, subject, inputs, parameters, result));
  EXPECT_THAT(parameters, ElementsAre(ParameterChange{0, "MC_ROLLRATE_P", 0.2f}));

  inputs.parameters = {{2, "MC_ROLLRATE_I", 0.3f}};
  EXPECT_FALSE(adds_constants(*lacks, subject, inputs, parameters, result));
  EXPECT_EQ(result.verdict, Verdict::unsupported);
  EXPECT_EQ(result.reason, "MC_ROLLRATE_I is 0.2 in the port, and this vector sets 0.3");
}

}  // namespace
}  // namespace attest
