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
  diagnosis.first_stage = Stage::integrator;
  diagnosis.in_first_stage = 7;
  return diagnosis;
}

TEST(DiagnosisText, WithoutALikeFaultHasTheStageOnly) {
  EXPECT_EQ(diagnosis_text(unlike_every_fault()),
            "it looks like no fault of the catalogue; 7 of 9 failing vectors deviate first in the "
            "integrator\n");
}

TEST(DiagnosisText, ListsEachMistakeAndWhatNoneExplains) {
  Diagnosis diagnosis = unlike_every_fault();
  diagnosis.suspects = {
      {faults::find_fault("yaw-reversed"), 4, 9, {}},
      {faults::find_fault("tpa-missing"), 2, 9, {faults::find_fault("tpa-on-d")}}};
  diagnosis.unexplained = 3;
  Pattern pattern;
  pattern.stage = Stage::integrator;
  pattern.axes = "yaw";
  pattern.relation = "are 0";
  pattern.condition = "the vehicle <lands>";
  pattern.vectors = 3;
  pattern.groups = {"anti_windup", "modes"};
  diagnosis.patterns = {pattern};
  diagnosis.remarks = {"its instances share state"};
  const std::string text = diagnosis_text(diagnosis);
  EXPECT_THAT(text, testing::StartsWith("it looks like:\n  `yaw-reversed`: "));
  EXPECT_THAT(
      text, HasSubstr("      gives all or some of the port's values in 4 of 9 failing vectors\n"));
  EXPECT_THAT(text, HasSubstr("      equally well: `tpa-on-d`\n"));
  EXPECT_THAT(text, HasSubstr("3 of 9 failing vectors have deviations that these do not explain\n"
                              "  in the integrator: values about yaw are 0, only where the "
                              "vehicle <lands>\n"
                              "      in 3 failing vectors of the groups anti_windup, modes\n"
                              "its instances share state\n"));
  EXPECT_THAT(html_report({sample_run(), diagnosis, {}}), HasSubstr("the vehicle &lt;lands&gt;"));
}

Pattern pattern_in(Stage stage, std::size_t vectors, const std::string& group) {
  Pattern pattern;
  pattern.stage = stage;
  pattern.vectors = vectors;
  pattern.groups = {group};
  return pattern;
}

TEST(DiagnosisText, BeginsWithWhatMoreVectorsHaveInCommon) {
  Diagnosis diagnosis = unlike_every_fault();
  diagnosis.suspects = {{faults::find_fault("yaw-reversed"), 1, 9, {}}};
  diagnosis.unexplained = 9;
  diagnosis.patterns = {pattern_in(Stage::integrator, 8, "saturation")};
  EXPECT_THAT(diagnosis_text(diagnosis),
              testing::StartsWith("9 of 9 failing vectors have deviations that the faults of the "
                                  "catalogue do not explain\n"
                                  "  in the integrator: values deviate\n"
                                  "      in 8 failing vectors of the group saturation\n"
                                  "in part it looks like:\n  `yaw-reversed`: "));
}

TEST(DiagnosisText, OfAnUnknownMistakeHasWhatItsDeviationsHaveInCommon) {
  Diagnosis diagnosis = unlike_every_fault();
  diagnosis.patterns = {pattern_in(Stage::sticks, 1, "sticks")};
  EXPECT_THAT(diagnosis_text(diagnosis),
              testing::EndsWith("  in the sticks: values deviate\n"
                                "      in 1 failing vector of the group sticks\n"));
}

TEST(DiagnosisText, IsAboveTheVerdict) {
  Diagnosis diagnosis = unlike_every_fault();
  diagnosis.suspects = {{faults::find_fault("yaw-reversed"), 9, 9, {}}};
  diagnosis.specific_case = "px4-v1.5.5/modes/acro";
  diagnosis.why = "A stick.";
  diagnosis.unexplained = 1;
  std::string text = render_summary(sample_run(), 1, {}, diagnosis);
  EXPECT_THAT(text, testing::ContainsRegex("\nit looks like:\n  `yaw-reversed`[^\n]*\n"
                                           "      gives [^\n]*\n1 of [^\n]*\nFAIL [^\n]*\n$"));
  EXPECT_LT(text.find("it tests: A stick."), text.find("\nconformance:"));
  diagnosis.unexplained = 0;
  text = render_summary(sample_run(), 1, {}, diagnosis);
  EXPECT_THAT(text, Not(HasSubstr("it tests: A stick."))) << "the mistake is known";
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
  EXPECT_THAT(page, HasSubstr("7 of 9 failing vectors deviate first in the integrator"));
  diagnosis.why.clear();  // the caller does not know the case
  EXPECT_THAT(diagnosis_text(diagnosis), Not(HasSubstr("it tests")));
}

}  // namespace
}  // namespace attest
