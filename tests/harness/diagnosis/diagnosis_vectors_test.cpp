// Which vectors a diagnosis uses.
#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/diagnosis/diagnosis_job.hpp"
#include "tests/harness/verify/small_suite.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// Cases of 20 ms, so the number of ticks gives the rate: 2 at 100 Hz, 5 at 250 Hz, 160 at 8 kHz.
class DiagnosisVectorsTest : public testing::Test {
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

  std::vector<DiagnosisVector> vectors() const { return diagnosis_vectors(cases_, results_); }
  std::vector<std::size_t> ticks_of_vectors() const {
    std::vector<std::size_t> ticks;
    for (const DiagnosisVector& vector : vectors()) ticks.push_back(ticks_of(vector));
    return ticks;
  }
  static std::size_t ticks_of(const DiagnosisVector& vector) {
    return stimulate(*vector.the_case, vector.rate).samples.size();
  }

  SmallSuite suite_;
  Case level_ = [this] {
    suite_.add_unblessed("level", "");
    return suite_[0];
  }();
  std::vector<SelectedCase> cases_;
  std::vector<VectorResult> results_;
};

TEST_F(DiagnosisVectorsTest, WhereNothingFailsNothingIsRun) {
  add_case("a");
  add_result("a", 250, Verdict::pass);
  EXPECT_THAT(vectors(), IsEmpty());
}

TEST_F(DiagnosisVectorsTest, ACaseIsRunAtItsRateNearestTo250Hz) {
  for (auto rates : std::vector<std::vector<int>>{
           {100, 250, 8000}, {8000, 250, 100}, {250, 8000, 100}, {100, 8000, 250}}) {
    cases_.clear();
    results_.clear();
    add_case("a");
    for (const int hz : rates) add_result("a", hz, Verdict::fail);
    EXPECT_THAT(ticks_of_vectors(), ElementsAre(5)) << rates[0];
  }
}

TEST_F(DiagnosisVectorsTest, TheRateIsOneThatFailed) {
  add_case("a");
  add_result("a", 8000, Verdict::fail);
  add_result("a", 100, Verdict::fail);
  add_result("a", 250, Verdict::skip);
  EXPECT_THAT(ticks_of_vectors(), ElementsAre(2));
}

TEST_F(DiagnosisVectorsTest, ThoseThatPassedComeLastAtTheirRateNearestTo250Hz) {
  add_case("good");
  add_case("bad", {3, Span::In::ticks});
  for (const int hz : {8000, 250, 100}) add_result("good", hz, Verdict::pass);
  add_result("bad", 250, Verdict::fail);
  EXPECT_THAT(ticks_of_vectors(), ElementsAre(3, 5));
}

TEST_F(DiagnosisVectorsTest, OnlyAFailureWithAValueIsOne) {
  for (const Verdict verdict : {Verdict::xfail, Verdict::skip, Verdict::unsupported}) {
    add_case(std::string(name_of(verdict)));
    add_result(cases_.back().the_case.name, 250, verdict);
  }
  add_case("dies");
  add_result("dies", 250, Verdict::crash).first.reset();
  EXPECT_THAT(vectors(), IsEmpty());
  add_case("rubbish", {7, Span::In::ticks});
  add_result("rubbish", 250, Verdict::non_finite);
  EXPECT_THAT(ticks_of_vectors(), ElementsAre(7));
}

TEST_F(DiagnosisVectorsTest, FlightsAreLeftOut) {
  add_case("a");
  add_result("a", 250, Verdict::fail).plant_configuration.emplace();
  EXPECT_THAT(vectors(), IsEmpty());
}

TEST_F(DiagnosisVectorsTest, IfInstancesShareStateTheirCasesAreLeftOut) {
  level_.group = "instances";
  add_case("second", {3, Span::In::ticks});
  add_result("second", 250, Verdict::fail);
  EXPECT_THAT(ticks_of_vectors(), ElementsAre(3));
  level_.group = "rates";
  add_case("p", {4, Span::In::ticks});
  add_result("p", 250, Verdict::fail);
  EXPECT_THAT(ticks_of_vectors(), ElementsAre(3, 4));
  results_.back().after = {"px4-v1.5.5/rates/d@250hz"};
  EXPECT_THAT(ticks_of_vectors(), ElementsAre(4));
}

// Running the whole catalogue on a long case takes long.
TEST_F(DiagnosisVectorsTest, LongCasesAreLeftOut) {
  add_case("long", {5000, Span::In::ticks});
  add_result("long", 250, Verdict::fail);
  EXPECT_THAT(vectors(), IsEmpty());
}

TEST_F(DiagnosisVectorsTest, FewAreRunAllInTheOrderOfTheCases) {
  add_cases("bad", 5, Verdict::fail);
  std::reverse(results_.begin(), results_.end());
  EXPECT_THAT(ticks_of_vectors(), ElementsAre(1, 2, 3, 4, 5));
}

// The whole catalogue runs on each, so only some vectors are used. Their spread is checked at the
// first, the middle and the last.
TEST_F(DiagnosisVectorsTest, OfManySomeAreUsedThatAreSpreadOverTheSuite) {
  add_cases("bad", 400, Verdict::fail);
  add_cases("good", 400, Verdict::pass);
  const auto all = vectors();
  ASSERT_EQ(all.size(), 360u);
  EXPECT_LE(ticks_of(all.front()), 20u);
  EXPECT_NEAR(static_cast<double>(ticks_of(all[120])), 200, 20);
  EXPECT_TRUE(all[239].failed);
  EXPECT_GE(ticks_of(all[239]), 380u);
  EXPECT_FALSE(all[240].failed);
  EXPECT_GE(ticks_of(all.back()), 380u);
}

// Vectors of one case in several profiles show the same mistakes.
TEST_F(DiagnosisVectorsTest, OfSeveralProfilesOneIsUsed) {
  for (const char* const profile : {"px4-v1.3.4", "px4-v1.5.5"}) {
    add_case("bad");
    cases_.back().the_case.profile = profile;
    add_result("bad", 250, Verdict::fail).profile = profile;
  }
  ASSERT_THAT(vectors(), SizeIs(1));
  EXPECT_EQ(vectors().front().the_case->profile, "px4-v1.5.5");
  results_.back().verdict = Verdict::pass;
  ASSERT_THAT(vectors(), SizeIs(2));
  EXPECT_EQ(vectors().front().the_case->profile, "px4-v1.3.4");
}

}  // namespace
}  // namespace attest
