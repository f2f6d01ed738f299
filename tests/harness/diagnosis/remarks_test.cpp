#include "harness/diagnosis/remarks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

VectorResult result(const std::string& group, const std::string& name, int hz, Verdict verdict) {
  VectorResult one;
  one.profile = "px4-v1.5.5";
  one.group = group;
  one.name = name;
  one.rate = Rate::hz(hz);
  one.verdict = verdict;
  return one;
}

TEST(Remarks, AboutAPortThatPassesThereAreNone) {
  EXPECT_THAT(remarks_on({}), IsEmpty());
  EXPECT_THAT(remarks_on({result("instances", "two", 250, Verdict::pass)}), IsEmpty());
}

TEST(Remarks, OnlyCasesOfInstancesFail) {
  std::vector<VectorResult> results{result("instances", "two", 250, Verdict::fail)};
  EXPECT_THAT(remarks_on(results), IsEmpty()) << "no other case was selected";
  for (const char* const name : {"p", "i", "d"}) {
    EXPECT_THAT(remarks_on(results), IsEmpty());
    results.push_back(result("rates", name, 250, Verdict::pass));
  }
  EXPECT_THAT(remarks_on(results), ElementsAre(HasSubstr("its instances share state")));
  results[1].verdict = Verdict::fail;
  EXPECT_THAT(remarks_on(results), IsEmpty());
  results[1].after = {"px4-v1.5.5/rates/d@250hz"};
  EXPECT_THAT(remarks_on(results), ElementsAre(HasSubstr("1 of the failing vectors pass")));
}

TEST(Remarks, ATimeoutAfterOthersDoesNotShowSharedState) {
  std::vector<VectorResult> results{result("rates", "p", 250, Verdict::timeout)};
  results[0].after = {"px4-v1.5.5/rates/d@250hz"};
  EXPECT_THAT(remarks_on(results), IsEmpty());
}

TEST(Remarks, ManyNonFiniteOutputsMayComeFromTheCompiler) {
  std::vector<VectorResult> results(9, result("robustness", "nan", 250, Verdict::non_finite));
  EXPECT_THAT(remarks_on(results), IsEmpty());
  results.push_back(results.front());
  EXPECT_THAT(remarks_on(results), ElementsAre(HasSubstr("10 of 10 failing vectors give NaN")));
  results.insert(results.end(), 11, result("rates", "p", 250, Verdict::fail));
  EXPECT_THAT(remarks_on(results), IsEmpty());
}

TEST(Remarks, CasesPassAtOneRateOnly) {
  std::vector<VectorResult> results;
  for (const char* const name : {"p", "i", "d"}) {
    for (const int hz : {100, 250, 500, 1000}) {
      results.push_back(result("rates", name, hz, hz == 500 ? Verdict::pass : Verdict::fail));
    }
  }
  EXPECT_THAT(remarks_on(results), ElementsAre(HasSubstr("the time step of 500 Hz")));
  for (VectorResult& one : results) {
    if (one.name == "d") one.verdict = Verdict::fail;
  }
  EXPECT_THAT(remarks_on(results), IsEmpty()) << "two cases may do so by chance";
}

TEST(Remarks, OnlyFlightsFail) {
  std::vector<VectorResult> results{result("flight", "hover", 250, Verdict::fail),
                                    result("rates", "p", 250, Verdict::pass)};
  results[0].plant_configuration.emplace();
  EXPECT_THAT(remarks_on(results), ElementsAre(HasSubstr("only flights fail")));
  results[1].verdict = Verdict::fail;
  EXPECT_THAT(remarks_on(results), IsEmpty());
  results[1].verdict = Verdict::skip;
  EXPECT_THAT(remarks_on(results), ElementsAre(HasSubstr("only flights were judged")));
  results.pop_back();
  EXPECT_THAT(remarks_on(results), ElementsAre(HasSubstr("run the cases in open loop, too")));
}

}  // namespace
}  // namespace attest
