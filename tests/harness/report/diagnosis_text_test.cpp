#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/conclusion.hpp"
#include "harness/report/report.hpp"
#include "harness/report/terminal.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::Not;

Diagnosis unlike_every_fault() {
  Diagnosis diagnosis;
  diagnosis.failing = 9;
  diagnosis.first_stages = only(Stage::rate_law) | only(Stage::integrator);
  diagnosis.in_first_stages = 7;
  return diagnosis;
}

TEST(DiagnosisText, WithoutALikeFaultHasTheStageOnly) {
  EXPECT_EQ(diagnosis_text(unlike_every_fault()),
            "it looks like no fault of the catalogue; 7 of 9 failing vectors deviate first in the "
            "rate law or the integrator\n");
}

TEST(DiagnosisText, HasTheNearestFaultWithItsShare) {
  Diagnosis diagnosis = unlike_every_fault();
  diagnosis.nearest = faults::find_fault("yaw-reversed");
  diagnosis.stage = diagnosis.nearest->stage;
  diagnosis.jaccard_index = 0.63;
  EXPECT_THAT(diagnosis_text(diagnosis), HasSubstr("the nearest is `yaw-reversed`\n"));
  EXPECT_THAT(diagnosis_text(diagnosis), HasSubstr("63% of the deviating values in common\n"));
}

TEST(DiagnosisText, EndsWithThePurposeOfTheMostSpecificCase) {
  Diagnosis diagnosis = unlike_every_fault();
  diagnosis.specific_case = "px4-v1.5.5/modes/acro";
  diagnosis.shown_by_it = 3;
  diagnosis.why = "A stick\nbeyond <1>.";
  const std::string text = diagnosis_text(diagnosis);
  EXPECT_THAT(text, testing::EndsWith("most specific failing case: px4-v1.5.5/modes/acro, which 3 "
                                      "faults of the catalogue would fail\n"
                                      "  it tests: A stick beyond <1>.\n"));
  const RunResult run = sample_run();
  EXPECT_THAT(render_summary(run, 1, {}, diagnosis), HasSubstr("it tests: A stick beyond <1>."));
  EXPECT_THAT(junit_report(run, diagnosis), HasSubstr("it tests: A stick beyond &lt;1&gt;."));
  const std::string page = html_report({run, diagnosis, {}});
  EXPECT_THAT(page, HasSubstr("px4-v1.5.5/modes/acro"));
  EXPECT_THAT(page, HasSubstr("It tests: A stick beyond &lt;1&gt;."));
  EXPECT_THAT(page, HasSubstr("7 of 9 failing vectors deviate first in the rate law or the"));
  diagnosis.why.clear();  // the caller does not know the case
  EXPECT_THAT(diagnosis_text(diagnosis), Not(HasSubstr("it tests")));
}

}  // namespace
}  // namespace attest
