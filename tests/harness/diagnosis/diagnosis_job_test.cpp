#include "harness/diagnosis/diagnosis_job.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/verify/small_suite.hpp"

namespace attest {
namespace {

using testing::AnyOf;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Lt;
using testing::Pair;
using testing::SizeIs;

// A vector on which a dropped yaw weight and a missing attenuation change the outputs.
const char* const tilted_and_loud =
    "[parameters]\nMC_TPA_BREAK = 0.3\n[control_state]\nroll_rate = 0.3\n"
    "[vehicle_attitude_setpoint]\nq_d = { tilt_deg = 40, yaw_deg = 25 }\nthrust = 0.8\n";

HostOptions here(const std::string& port) {
  HostOptions options = host_of(port);
  options.in_process = true;
  return options;
}

const Similarity& of_fault(const VectorSimilarity& vector, std::string_view id) {
  const auto all = faults::catalogue();
  const auto found = std::find(all.begin(), all.end(), faults::find_fault(id));
  return vector.similarities.at(static_cast<std::size_t>(found - all.begin()));
}

// ---- one vector ---------------------------------------------------------------------------------

Result<VectorAnswer> answer_to(const DiagnosisVector& vector, const HostOptions& port,
                               Level level = Level::numeric) {
  PortAnswerJob job({vector}, port, level);
  if (const auto opened = job.open(); !opened) return tl::unexpected(opened.error());
  return job.run(0);
}

class PortAnswerTest : public testing::Test {
 protected:
  PortAnswerTest() { suite_.add_unblessed("tilted", tilted_and_loud); }

  Result<VectorAnswer> run(const HostOptions& port, Level level = Level::numeric) {
    return answer_to({&suite_[0], Rate::hz(250), true}, port, level);
  }
  // The similarities of each fault with the port.
  VectorComparison compared(const HostOptions& port, const Hypothesis& base = {},
                            bool observes = false, std::size_t the_case = 0) {
    const DiagnosisVector vector{&suite_[the_case], Rate::hz(250), true};
    const auto answer = answer_to(vector, port);
    EXPECT_TRUE(answer && *answer);
    const AnsweredVector answered{vector, std::make_shared<const Outputs>((*answer)->outputs),
                                  (*answer)->fraction_bits, (*answer)->fixed_step};
    return ComparisonJob(answered, each_fault(base), observes).run(0).value();
  }

  SmallSuite suite_;
};

TEST_F(PortAnswerTest, TheFaultThatThePortHasMatchesItAtEveryTick) {
  for (const bool in_process : {true, false}) {
    HostOptions port = here("fault:tpa-missing");
    port.in_process = in_process;
    const VectorSimilarity found = compared(port).similarity;
    EXPECT_EQ(found.ticks, 30u);
    EXPECT_NE(found.deviating, 0u);
    EXPECT_TRUE(found.stage.has_value());
    EXPECT_THAT(found.similarities, SizeIs(faults::catalogue().size()));
    const Similarity& own = of_fault(found, "tpa-missing");
    EXPECT_EQ(own.matched, 30u);
    EXPECT_EQ(own.parted, 0u);
    EXPECT_GE(own.same, 30u);
    EXPECT_EQ(own.other, 0u);
    EXPECT_EQ(of_fault(found, "yaw-weight-dropped").matched, 0u);
  }
}

TEST_F(PortAnswerTest, ARightPortDoesNotDeviate) {
  const VectorSimilarity found = compared(here("builtin")).similarity;
  EXPECT_EQ(found.deviating, 0u);
  EXPECT_EQ(of_fault(found, "limits-exchanged").matched, 30u) << "as the law does";
  EXPECT_EQ(of_fault(found, "tpa-missing").matched, 0u);
}

TEST_F(PortAnswerTest, WithoutOutputsTheVectorHasThoseOfTheLaw) {
  const AnsweredVector vector{{&suite_[0], Rate::hz(250), false}};
  const std::vector<Hypothesis> hypotheses{{}, {faults::find_fault("tpa-missing")}};
  const auto found = ComparisonJob(vector, hypotheses, false).run(0).value().similarity;
  EXPECT_EQ(found.deviating, 0u);
  EXPECT_EQ(found.similarities[0].parted, 0u);
  EXPECT_NE(found.similarities[1].deviating, 0u);
}

// The same tolerances as for the verdict: a vector that passed must not count as failed here.
TEST_F(PortAnswerTest, TheTolerancesAreThoseOfTheCaseAndThePort) {
  const char* const wide =
      "[tolerance]\nwhy = \"x\"\nactuator_controls_0 = { absolute = 9 }\n"
      "mc_att_ctrl_status = { absolute = 9 }\n";
  suite_.add_unblessed("wide", std::string(tilted_and_loud) + wide);
  EXPECT_EQ(compared(here("fault:tpa-missing"), {}, false, 1).similarity.deviating, 0u);
}

TEST_F(PortAnswerTest, ANearMissDiffersWithinAShareOfTheTolerances) {
  suite_.add_unblessed("wide", std::string(tilted_and_loud) +
                                   "[tolerance]\nwhy = \"x\"\nactuator_controls_0 = { absolute = 9 "
                                   "}\nmc_att_ctrl_status = { absolute = 9 }\n");
  const DiagnosisVector vector{&suite_[1], Rate::hz(250), true};
  const auto answer = answer_to(vector, here("fault:tpa-missing"));
  ASSERT_TRUE(answer && *answer);
  const AnsweredVector answered{vector, std::make_shared<const Outputs>((*answer)->outputs)};
  const std::vector<Hypothesis> hypotheses{{}, {faults::find_fault("tpa-missing")}};
  const auto parted = [&](double share, std::size_t hypothesis) {
    const auto found = ComparisonJob(answered, hypotheses, false, false, share).run(0).value();
    return found.similarity.similarities[hypothesis].parted != 0;
  };
  EXPECT_FALSE(parted(1, 0));
  EXPECT_TRUE(parted(1e-4, 0));
  EXPECT_FALSE(parted(1e-4, 1));
}

TEST_F(PortAnswerTest, EachFaultIsTriedTogetherWithTheOthers) {
  const HostOptions both = here("fault:yaw-weight-dropped+tpa-missing");
  const VectorSimilarity alone = compared(both).similarity;
  const VectorSimilarity together = compared(both, {faults::find_fault("tpa-missing")}).similarity;
  EXPECT_EQ(of_fault(alone, "yaw-weight-dropped").matched, 0u);
  EXPECT_EQ(of_fault(together, "yaw-weight-dropped").matched, 30u);
  EXPECT_EQ(of_fault(together, "limits-exchanged").matched, 0u);
}

// The first hypothesis is what the port is expected to do.
TEST_F(PortAnswerTest, DeviationsAreObservedIfRequested) {
  const HostOptions port = here("fault:tpa-missing");
  const Observation found = compared(port, {faults::find_fault("yaw-reversed")}, true).observation;
  EXPECT_GT(found.at({Stage::rate_law, 0}).all.deviating, 0u);
  EXPECT_TRUE(compared(port).observation.empty());
}

// The integral deviates in the first step, and the controls one step later.
TEST_F(PortAnswerTest, TheFirstDeviationHasTheStageThatReportsCount) {
  const DiagnosisVector vector{&suite_[0], Rate::hz(250), true};
  const auto answer = answer_to(vector, here("fault:i-without-dt+yaw-reversed"));
  ASSERT_TRUE(answer && *answer);
  const AnsweredVector answered{vector, std::make_shared<const Outputs>((*answer)->outputs)};
  const auto first = [&](const Hypothesis& expected) {
    return ComparisonJob(answered, {expected}, true).run(0).value();
  };
  EXPECT_EQ(first({}).similarity.stage, Stage::attitude_law);
  EXPECT_EQ(first({}).first, (FirstStage{Stage::attitude_law, Stage::attitude_law}));
  const VectorComparison left = first({faults::find_fault("yaw-reversed")});
  EXPECT_EQ(left.first, (FirstStage{Stage::integrator, Stage::integrator}));
  EXPECT_EQ(left.similarity.stage, Stage::attitude_law);
  EXPECT_EQ(first({faults::find_fault("yaw-reversed"), faults::find_fault("i-without-dt")}).first,
            std::nullopt);
}

// This case calls atan2 alone, whose results some libraries round correctly.
TEST_F(PortAnswerTest, AtTheLevelExactTheCallsOfTheCLibraryAreTried) {
  const auto found = [&](const char* port, Level level) { return run(here(port), level).value(); };
  const LibraryMatches right = found("builtin", Level::exact)->library;
  ASSERT_THAT(right.with_set, SizeIs(library_call_sets));
  constexpr LibraryCalls atan2f = 1 << 5;
  for (LibraryCalls calls = 0; calls < atan2f; ++calls) {
    EXPECT_EQ(right.with_set[calls], 30u) << calls;
  }
  for (const auto& [single, matched] : right.with_single) {
    EXPECT_THAT(single, AnyOf("atan2f@tilt_error", "atan2f@yaw_error"));
    EXPECT_LT(matched, 30u) << single;
  }
  EXPECT_EQ(right.with("atan2f@unheard_of"), 30u);
  EXPECT_THAT(found("fault:tpa-missing", Level::exact)->library.with_set, Each(Lt(30u)));
  EXPECT_THAT(found("builtin", Level::numeric)->library.with_set, IsEmpty());
}

TEST_F(PortAnswerTest, APortThatGoesWrongHasNoAnswer) {
  HostOptions hangs = host_of("builtin");
  hangs.hangs = "no answer";
  for (const HostOptions& port : {here(test_port("step_fails")), hangs}) {
    const auto found = run(port);
    ASSERT_TRUE(found) << found.error().to_string();
    EXPECT_FALSE(*found);
  }
}

TEST_F(PortAnswerTest, APortThatCannotBeOpenedIsAnError) {
  EXPECT_FALSE(run(here("fault:unheard-of")));
}

TEST_F(PortAnswerTest, AGroupThatThePortDeclinesHasNoAnswer) {
  Case tailsitter = suite_[0];
  const HostOptions port = here(test_port("no_tailsitter"));
  const auto ran = [&] { return answer_to({&tailsitter, Rate::hz(250), true}, port); };
  EXPECT_TRUE(*ran());
  tailsitter.group = "tailsitter";
  EXPECT_FALSE(*ran());
}

// The first dt of such a port is its period; other ports start with the longest dt.
TEST_F(PortAnswerTest, APortWithAFixedStepIsGivenTheCaseFromOnePeriodOn) {
  EXPECT_EQ(compared(here(test_port("fixed_step"))).similarity.deviating, 0u);
  EXPECT_NE(compared(here(test_port("fixed_step_gain_off"))).similarity.deviating, 0u);
}

TEST(DiagnosisCodec, AnAnswerComesBackAsItWas) {
  const auto back = [](const Result<VectorAnswer>& result) {
    return Codec<VectorAnswer>::decode(Codec<VectorAnswer>::encode(result));
  };
  PortAnswer answer{Outputs(2), {{7, 8}, {{"expf@decay", 9}}}, 20, Rate::hz(1000, 3)};
  for (std::size_t i = 0; i < outputs_size; ++i) {
    answer.outputs[1].bytes[i] = static_cast<std::byte>(i);
  }
  const auto one = back(VectorAnswer(answer));
  ASSERT_TRUE(one && *one);
  ASSERT_THAT((*one)->outputs, SizeIs(2));
  EXPECT_EQ((*one)->outputs[0].bytes, answer.outputs[0].bytes);
  EXPECT_EQ((*one)->outputs[1].bytes, answer.outputs[1].bytes);
  EXPECT_THAT((*one)->library.with_set, ElementsAre(7, 8));
  EXPECT_THAT((*one)->library.with_single, ElementsAre(Pair("expf@decay", 9u)));
  EXPECT_EQ((*one)->fraction_bits, 20);
  EXPECT_EQ((*one)->fixed_step, Rate::hz(1000, 3));
  const auto none = back(VectorAnswer());
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
  const auto error = back(fail("no port"));
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message, "no port");
}

TEST(DiagnosisCodec, AComparisonComesBackAsItWas) {
  VectorComparison sent;
  sent.similarity = {
      30,           5,  {{1, 2, 3, 4, 6, 0.5}, {7, 8, 9, 10, 11, 12, 13, 14}}, Stage::mixer,
      "modes/acro", 1.5};
  sent.first = FirstStage{Stage::sticks, Stage::attitude_law};
  Observed& observed = sent.observation[{Stage::rate_law, 2}];
  observed.all = {3, 4};
  observed.where = {{"it is the first step", {1, 2}, ConditionKind::input}};
  observed.relations.values = 3;
  observed.relations.quotient_to = 0.25;
  const auto one = Codec<VectorComparison>::decode(Codec<VectorComparison>::encode(sent)).value();
  EXPECT_EQ(one.similarity.ticks, 30u);
  EXPECT_EQ(one.similarity.deviating, 5u);
  EXPECT_EQ(one.similarity.misfit, 1.5);
  EXPECT_EQ(one.similarity.stage, Stage::mixer);
  EXPECT_EQ(one.first, (FirstStage{Stage::sticks, Stage::attitude_law}));
  EXPECT_EQ(one.similarity.case_id, "modes/acro");
  ASSERT_THAT(one.similarity.similarities, SizeIs(2));
  const Similarity& last = one.similarity.similarities[1];
  EXPECT_THAT((std::array{last.matched, last.same, last.other}), ElementsAre(7, 8, 9));
  EXPECT_EQ(last.deviating, 10u);
  EXPECT_EQ(last.parted, 11u);
  EXPECT_EQ(last.misfit, 12);
  EXPECT_EQ(last.acts, 13u);
  EXPECT_EQ(last.parts, 14u);
  EXPECT_EQ(one.similarity.similarities[0].acts, Similarity::never);
  const Observed& back = one.observation.at({Stage::rate_law, 2});
  EXPECT_EQ(back.all.deviating, 3u);
  ASSERT_THAT(back.where, SizeIs(1));
  EXPECT_EQ(back.where[0].condition, "it is the first step");
  EXPECT_EQ(back.where[0].tally.agreeing, 2u);
  EXPECT_EQ(back.where[0].kind, ConditionKind::input);
  EXPECT_EQ(back.relations.values, 3u);
  EXPECT_EQ(back.relations.quotient_to, 0.25);
}

}  // namespace
}  // namespace attest
