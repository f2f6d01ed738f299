#include "harness/diagnosis/diagnosis_job.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
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

class DiagnosisJobTest : public testing::Test {
 protected:
  DiagnosisJobTest() { suite_.add_unblessed("tilted", tilted_and_loud); }

  Result<VectorDiagnosis> run(const HostOptions& port, const faults::Fault* partner = nullptr) {
    return DiagnosisJob(suite_[0], Rate::hz(250), partner, port).run(0);
  }

  SmallSuite suite_;
};

TEST_F(DiagnosisJobTest, TheFaultThatThePortHasMatchesItAtEveryTick) {
  for (const bool in_process : {true, false}) {
    HostOptions port = here("fault:tpa-missing");
    port.in_process = in_process;
    const auto found = run(port);
    ASSERT_TRUE(found && *found);
    EXPECT_EQ((*found)->ticks, 30u);
    EXPECT_TRUE((*found)->deviates);
    EXPECT_THAT((*found)->similarities, SizeIs(faults::catalogue().size()));
    const Similarity& own = of_fault(**found, "tpa-missing");
    EXPECT_EQ(own.matched, 30u);
    EXPECT_GE(own.intersection, 30u);
    EXPECT_EQ(own.intersection, own.union_size);
    EXPECT_EQ(of_fault(**found, "yaw-weight-dropped").matched, 0u);
  }
}

TEST_F(DiagnosisJobTest, ARightPortDoesNotDeviate) {
  const auto found = run(here("builtin"));
  ASSERT_TRUE(found && *found);
  EXPECT_FALSE((*found)->deviates);
  EXPECT_EQ(of_fault(**found, "limits-exchanged").matched, 30u) << "as the law does";
  EXPECT_EQ(of_fault(**found, "tpa-missing").matched, 0u);
  EXPECT_EQ(of_fault(**found, "tpa-missing").intersection, 0u);
}

// The same tolerances as for the verdict: a vector that passed must not count as failed here.
TEST_F(DiagnosisJobTest, TheTolerancesAreThoseOfTheCaseAndThePort) {
  const char* const wide =
      "[tolerance]\nwhy = \"x\"\nactuator_controls_0 = { absolute = 9 }\n"
      "mc_att_ctrl_status = { absolute = 9 }\n";
  suite_.add_unblessed("wide", std::string(tilted_and_loud) + wide);
  const auto found =
      DiagnosisJob(suite_[1], Rate::hz(250), nullptr, here("fault:tpa-missing")).run(0);
  ASSERT_TRUE(found && *found);
  EXPECT_FALSE((*found)->deviates);
}

TEST_F(DiagnosisJobTest, WithAPartnerEachFaultIsTriedTogetherWithIt) {
  const HostOptions both = here("fault:yaw-weight-dropped+tpa-missing");
  const auto alone = run(both);
  const auto together = run(both, faults::find_fault("tpa-missing"));
  ASSERT_TRUE(alone && *alone && together && *together);
  EXPECT_EQ(of_fault(**alone, "yaw-weight-dropped").matched, 0u);
  EXPECT_EQ(of_fault(**alone, "tpa-missing").matched, 0u);
  EXPECT_EQ(of_fault(**together, "yaw-weight-dropped").matched, 30u);
  EXPECT_EQ(of_fault(**together, "limits-exchanged").matched, 0u);
}

// This case calls atan2 alone, whose results some libraries round correctly.
TEST_F(DiagnosisJobTest, AtTheLevelExactTheCallsOfTheCLibraryAreTried) {
  const auto found = [&](const char* port, Level level) {
    return DiagnosisJob(suite_[0], Rate::hz(250), nullptr, here(port), level).run(0).value();
  };
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

TEST_F(DiagnosisJobTest, APortThatGoesWrongHasNoDiagnosis) {
  HostOptions hangs = host_of("builtin");
  hangs.hangs = "no answer";
  for (const HostOptions& port : {here(test_port("step_fails")), hangs}) {
    const auto found = run(port);
    ASSERT_TRUE(found) << found.error().to_string();
    EXPECT_FALSE(*found);
  }
}

TEST_F(DiagnosisJobTest, APortThatCannotBeOpenedIsAnError) {
  EXPECT_FALSE(run(here("fault:unheard-of")));
}

TEST_F(DiagnosisJobTest, AGroupThatThePortDeclinesHasNoDiagnosis) {
  Case tailsitter = suite_[0];
  const HostOptions port = here(test_port("no_tailsitter"));
  const auto ran = [&] { return DiagnosisJob(tailsitter, Rate::hz(250), nullptr, port).run(0); };
  EXPECT_TRUE(*ran());
  tailsitter.group = "tailsitter";
  EXPECT_FALSE(*ran());
}

// The first dt of such a port is its period; other ports start with the longest dt.
TEST_F(DiagnosisJobTest, APortWithAFixedStepIsGivenTheCaseFromOnePeriodOn) {
  const auto right = run(here(test_port("fixed_step")));
  ASSERT_TRUE(right && *right);
  EXPECT_FALSE((*right)->deviates);
  const auto wrong = run(here(test_port("fixed_step_gain_off")));
  ASSERT_TRUE(wrong && *wrong);
  EXPECT_TRUE((*wrong)->deviates);
}

TEST(DiagnosisCodec, AResultComesBackAsItWas) {
  const auto back = [](const Result<VectorDiagnosis>& result) {
    return Codec<VectorDiagnosis>::decode(Codec<VectorDiagnosis>::encode(result));
  };
  for (const bool deviates : {true, false}) {
    const StageSet stages = only(Stage::sticks) | only(Stage::actuators);
    const auto one = back(VectorSimilarity{30,
                                           deviates,
                                           {{1, 2, 3}, {4, 5, 6, true}},
                                           stages,
                                           "modes/acro",
                                           {{7, 8}, {{"expf@decay", 9}}}});
    ASSERT_TRUE(one && *one);
    EXPECT_EQ((*one)->ticks, 30u);
    EXPECT_EQ((*one)->deviates, deviates);
    ASSERT_THAT((*one)->similarities, SizeIs(2));
    const Similarity& last = (*one)->similarities[1];
    EXPECT_THAT((std::array{last.matched, last.intersection, last.union_size}),
                ElementsAre(4, 5, 6));
    EXPECT_TRUE(last.deviates);
    EXPECT_FALSE((*one)->similarities[0].deviates);
    EXPECT_EQ((*one)->stages, stages);
    EXPECT_EQ((*one)->case_id, "modes/acro");
    EXPECT_THAT((*one)->library.with_set, ElementsAre(7, 8));
    EXPECT_THAT((*one)->library.with_single, ElementsAre(Pair("expf@decay", 9u)));
  }
  const auto none = back(VectorDiagnosis());
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
  const auto error = back(fail("no port"));
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message, "no port");
}

// ---- which vectors ------------------------------------------------------------------------------

// Cases of 20 ms, so the number of ticks gives the rate: 2 at 100 Hz, 5 at 250 Hz, 160 at 8 kHz.
class DiagnosisJobsTest : public testing::Test {
 protected:
  void add_case(const std::string& name, Span duration = {0.02, Span::In::seconds}) {
    Case the_case = level_;
    the_case.name = name;
    the_case.duration = duration;
    cases_.push_back({std::move(the_case), {}});
  }
  VectorResult& add_result(const std::string& name, int hz, Verdict verdict) {
    VectorResult result;
    result.profile = level_.profile;
    result.group = level_.group;
    result.name = name;
    result.rate = Rate::hz(hz);
    result.verdict = verdict;
    if (verdict != Verdict::pass) result.first.emplace();
    results_.push_back(std::move(result));
    return results_.back();
  }
  // Cases of 1, 2, 3, ... ticks, all at 250 Hz.
  void add_cases(const std::string& name, int count, Verdict verdict) {
    for (int i = 1; i <= count; ++i) {
      add_case(fmt::format("{}_{}", name, i), {static_cast<double>(i), Span::In::ticks});
      add_result(cases_.back().the_case.name, 250, verdict);
    }
  }

  Jobs<VectorDiagnosis> jobs(const faults::Fault* partner = nullptr) const {
    return diagnosis_jobs(cases_, results_, here("fault:tpa-missing"), partner);
  }
  std::vector<std::size_t> ticks_of_jobs() const {
    std::vector<std::size_t> ticks;
    for (const auto& job : jobs()) ticks.push_back(ticks_of(*job));
    return ticks;
  }
  static std::size_t ticks_of(Job<VectorDiagnosis>& job) { return job.run(0).value()->ticks; }

  SmallSuite suite_;
  Case level_ = [this] {
    suite_.add_unblessed("level", "");
    return suite_[0];
  }();
  std::vector<SelectedCase> cases_;
  std::vector<VectorResult> results_;
};

TEST_F(DiagnosisJobsTest, WhereNothingFailsNothingIsRun) {
  add_case("a");
  add_result("a", 250, Verdict::pass);
  EXPECT_THAT(jobs(), IsEmpty());
}

TEST_F(DiagnosisJobsTest, ACaseIsRunAtItsRateNearestTo250Hz) {
  for (auto rates : std::vector<std::vector<int>>{
           {100, 250, 8000}, {8000, 250, 100}, {250, 8000, 100}, {100, 8000, 250}}) {
    cases_.clear();
    results_.clear();
    add_case("a");
    for (const int hz : rates) add_result("a", hz, Verdict::fail);
    EXPECT_THAT(ticks_of_jobs(), ElementsAre(5)) << rates[0];
  }
}

TEST_F(DiagnosisJobsTest, TheRateIsOneThatFailed) {
  add_case("a");
  add_result("a", 8000, Verdict::fail);
  add_result("a", 100, Verdict::fail);
  add_result("a", 250, Verdict::skip);
  EXPECT_THAT(ticks_of_jobs(), ElementsAre(2));
}

TEST_F(DiagnosisJobsTest, AsManyThatPassedAreRunAtTheirRateNearestTo250Hz) {
  add_case("good");
  add_case("bad", {3, Span::In::ticks});
  for (const int hz : {8000, 250, 100}) add_result("good", hz, Verdict::pass);
  add_result("bad", 250, Verdict::fail);
  EXPECT_THAT(ticks_of_jobs(), ElementsAre(3, 5));
}

TEST_F(DiagnosisJobsTest, OnlyAFailureWithAValueIsOne) {
  for (const Verdict verdict : {Verdict::xfail, Verdict::skip, Verdict::unsupported}) {
    add_case(std::string(name_of(verdict)));
    add_result(cases_.back().the_case.name, 250, verdict);
  }
  add_case("dies");
  add_result("dies", 250, Verdict::crash).first.reset();
  EXPECT_THAT(jobs(), IsEmpty());
  add_case("rubbish", {7, Span::In::ticks});
  add_result("rubbish", 250, Verdict::non_finite);
  EXPECT_THAT(ticks_of_jobs(), ElementsAre(7));
}

TEST_F(DiagnosisJobsTest, FlightsAreLeftOut) {
  add_case("a");
  add_result("a", 250, Verdict::fail).plant_configuration.emplace();
  EXPECT_THAT(jobs(), IsEmpty());
}

// Running the whole catalogue on a long case takes long.
TEST_F(DiagnosisJobsTest, LongCasesAreLeftOut) {
  add_case("long", {5000, Span::In::ticks});
  add_result("long", 250, Verdict::fail);
  EXPECT_THAT(jobs(), IsEmpty());
}

TEST_F(DiagnosisJobsTest, FewAreRunAllInTheOrderOfTheCases) {
  add_cases("bad", 5, Verdict::fail);
  std::reverse(results_.begin(), results_.end());
  EXPECT_THAT(ticks_of_jobs(), ElementsAre(1, 2, 3, 4, 5));
}

// Each job runs the whole catalogue, so only some vectors are run. Their spread is checked at the
// first, the middle and the last.
TEST_F(DiagnosisJobsTest, OfManyThatFailSomeAreRunThatAreSpreadOverTheCorpus) {
  add_cases("bad", 200, Verdict::fail);
  const auto all = jobs();
  ASSERT_GE(all.size(), 10u);
  ASSERT_LE(all.size(), 100u) << "in a second or two";
  EXPECT_LE(ticks_of(*all.front()), 20u);
  EXPECT_NEAR(static_cast<double>(ticks_of(*all[all.size() / 2])), 100, 20);
  EXPECT_GE(ticks_of(*all.back()), 180u);
}

TEST_F(DiagnosisJobsTest, OfManyThatPassSomeAreRunThatAreSpreadOverTheCorpus) {
  add_cases("bad", 60, Verdict::fail);
  add_cases("good", 200, Verdict::pass);
  const auto all = jobs();
  ASSERT_GE(all.size(), 20u);
  ASSERT_LE(all.size(), 160u) << "in a second or two";
  EXPECT_GE(ticks_of(*all.back()), 180u);
}

TEST_F(DiagnosisJobsTest, EachTriesTheFaultsTogetherWithThePartner) {
  suite_.add_unblessed("tilted", tilted_and_loud);
  cases_.push_back({suite_[1], {}});
  add_result("tilted", 250, Verdict::fail);
  const auto alone = jobs();
  const auto together = jobs(faults::find_fault("tpa-missing"));
  ASSERT_THAT(together, SizeIs(1));
  EXPECT_EQ(of_fault(*alone[0]->run(0).value(), "limits-exchanged").matched, 0u);
  EXPECT_EQ(of_fault(*together[0]->run(0).value(), "limits-exchanged").matched, 30u);
}

}  // namespace
}  // namespace attest
