#include "harness/report/matrix.hpp"

#include <gtest/gtest.h>

#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

TEST(Matrix, HasARowForEachGroupAndACellForEachRate) {
  const Matrix matrix = matrix_of(sample_run());
  ASSERT_EQ(matrix.rows.size(), 4u);
  EXPECT_EQ(matrix.rows[0].group, "attitude");
  ASSERT_EQ(matrix.rates.size(), 4u);
  const MatrixCell& cell = matrix.rows[0].cells[1];  // at 250 Hz
  EXPECT_EQ(cell.passed, 1u);
  EXPECT_EQ(cell.failed, 2u);
  EXPECT_EQ(text_of(cell), "1/3");
  EXPECT_EQ(text_of(matrix.rows[0].cells[3]), "-");
  EXPECT_FALSE(matrix.rows[0].cells[3].worst);
}

TEST(Matrix, TheWorstVerdictIsTheOneToSeeFirst) {
  const Matrix matrix = matrix_of(sample_run());
  EXPECT_EQ(matrix.rows[0].cells[1].worst, Verdict::non_finite);
  EXPECT_EQ(matrix.rows[2].total.worst, Verdict::crash);
  EXPECT_EQ(total_of(matrix).total.worst, Verdict::crash);
}

TEST(Matrix, AVectorThatWasNotJudgedDoesNotHideOneThatPassed) {
  RunResult run = passing_run();
  run.results.front().verdict = Verdict::skip;
  EXPECT_EQ(matrix_of(run).rows[0].cells[0].worst, Verdict::pass);
  for (VectorResult& result : run.results) result.verdict = Verdict::skip;
  EXPECT_EQ(matrix_of(run).rows[0].cells[0].worst, Verdict::skip);
}

TEST(Matrix, TheHeadroomIsTheSmallestOfThoseThatPassed) {
  const Matrix matrix = matrix_of(sample_run());
  EXPECT_EQ(matrix.rows[0].total.headroom, 12.34);
  EXPECT_EQ(matrix.rows[0].cells[1].headroom, 40);
  EXPECT_FALSE(matrix.rows[2].total.headroom);
}

TEST(Matrix, TotalsAreOfAllOrOfAProfile) {
  RunResult run = sample_run();
  run.results.push_back(passed("attitude", "a", Rate::hz(250)));
  run.results.back().profile = "px4-v1.3.4";
  const Matrix matrix = matrix_of(run);
  EXPECT_EQ(total_of(matrix).total.all(), run.results.size());
  EXPECT_EQ(text_of(total_of(matrix, "px4-v1.3.4").total), "1");
  EXPECT_EQ(total_of(matrix, "px4-v1.5.5").total.all(), run.results.size() - 1);
}

}  // namespace
}  // namespace attest
