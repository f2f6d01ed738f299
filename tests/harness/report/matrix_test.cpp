#include "harness/report/matrix.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/accuracy.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

VectorResult with(Verdict verdict, const std::string& group, Rate rate) {
  VectorResult result = passed(group, "a", rate);
  result.verdict = verdict;
  return result;
}

// The cell of the first profile.
Cell cell_of(const RunResult& run, std::size_t row, std::size_t column) {
  return matrices_of(run).front().rows.at(row).at(column);
}

std::string text_of_first(const RunResult& run, TerminalStyle style = {}) {
  return render_text(matrices_of(run).front(), style);
}

TEST(Matrix, ACellSaysHowManyPassedOfThoseThatRan) {
  RunResult run;
  run.results = {with(Verdict::pass, "attitude", Rate::hz(50)),
                 with(Verdict::pass, "attitude", Rate::hz(50)),
                 with(Verdict::crash, "attitude", Rate::hz(100)),
                 with(Verdict::pass, "attitude", Rate::hz(100)),
                 with(Verdict::xfail, "attitude", Rate::hz(100)),
                 with(Verdict::skip, "b", Rate::hz(1000, 3))};
  EXPECT_EQ(text_of_first(run),
            "px4-v1.5.5: vectors by group and rate [Hz]\n"
            "  group     50    100  1000/3  total\n"
            "  attitude   2  1/2+1       -  3/4+1\n"
            "  b          -      -     0+1    0+1\n"
            "  total      2  1/2+1     0+1  3/4+2\n");
}

TEST(Matrix, ProfilesHaveTheirOwnAndThoseThatFailComeFirst) {
  RunResult run = passing_run();
  run.results.push_back(with(Verdict::crash, "attitude", Rate::hz(250)));
  run.results.back().profile = "px4-v1.3.4";
  const auto matrices = matrices_of(run);
  ASSERT_EQ(matrices.size(), 2u);
  EXPECT_EQ(matrices[0].caption, "px4-v1.3.4: vectors by group and rate [Hz]");
  EXPECT_EQ(matrices[0].rows.back().back().text, "0/1");
  EXPECT_EQ(matrices[1].rows.back().back().text, "6");
}

TEST(Matrix, BreaksIntoBlocksThatFit) {
  EXPECT_EQ(text_of_first(passing_run(), {.colour = false, .width = 17}),
            "px4-v1.5.5: vectors by group and rate [Hz]\n"
            "  group     50\n"
            "  attitude   3\n"
            "  total      3\n"
            "\n"
            "  group     250\n"
            "  attitude    3\n"
            "  total       3\n"
            "\n"
            "  group     total\n"
            "  attitude      6\n"
            "  total         6\n");
}

TEST(Matrix, ColoursDoNotMoveColumns) {
  RunResult run = passing_run();
  run.results.front().verdict = Verdict::fail;
  EXPECT_THAT(text_of_first(run, {.colour = true, .width = 0}),
              HasSubstr("  attitude  \x1b[31m2/3\x1b[0m    \x1b[32m3\x1b[0m"));
}

TEST(Matrix, IsEmptyWithoutResults) { EXPECT_THAT(matrices_of(RunResult{}), IsEmpty()); }

TEST(Matrix, TheWorstVerdictIsTheOneToSeeFirst) {
  EXPECT_EQ(cell_of(sample_run(), 0, 2).verdict, Verdict::non_finite);  // at 250 Hz
  EXPECT_EQ(cell_of(sample_run(), 0, 2).text, "1/3");
  const auto rows = matrices_of(sample_run()).front().rows;
  EXPECT_EQ(rows[2].back().verdict, Verdict::crash);
  EXPECT_EQ(rows.back().back().verdict, Verdict::crash);
  EXPECT_FALSE(rows[0][4].verdict);  // no result
}

TEST(Matrix, AVectorThatWasNotJudgedDoesNotHideOneThatPassed) {
  RunResult run = passing_run();
  run.results.front().verdict = Verdict::skip;
  EXPECT_EQ(cell_of(run, 0, 1).verdict, Verdict::pass);
}

// As if the port has another profile: its vectors are a line of what is counted apart.
TEST(Matrix, AProfileOfWhichNothingWasJudgedHasNoTable) {
  RunResult run = passing_run();
  for (VectorResult& result : run.results) result.verdict = Verdict::skip;
  EXPECT_THAT(matrices_of(run), IsEmpty());
  run.results.push_back(passed("attitude", "roll_30", Rate::hz(250)));
  run.results.back().profile = "px4-v1.3.4";
  EXPECT_EQ(matrices_of(run).size(), 1U);
  EXPECT_THAT(matrix_by_profile(run).header, testing::ElementsAre("group", "px4-v1.3.4", "total"));
}

TEST(Matrix, TheHeadroomIsTheSmallestOfThoseThatPassed) {
  const auto rows = matrices_of(sample_run()).front().rows;
  EXPECT_EQ(rows[0].back().small, "12\u00d7");
  EXPECT_EQ(rows[0][2].small, "40\u00d7");
  EXPECT_EQ(rows[2].back().small, "");
}

TEST(Accuracy, HasTheLargestDeviationOfEachSignalAndItsGroups) {
  RunResult run = passing_run();
  EXPECT_FALSE(accuracy_of(run));
  const auto roll = *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.roll");
  run.results[0].group = "attitude";
  run.results[0].largest = {{roll, 1e-6}};
  run.results[1].group = "large_angle";
  run.results[1].largest = {{roll, 0.0021}};
  run.results[2].verdict = Verdict::unsupported;
  run.results[2].largest = {{roll, 7}};
  const auto table = accuracy_of(run);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->rows.size(), 1u);
  EXPECT_EQ(table->rows[0][1].text, "rad/s");
  EXPECT_EQ(table->rows[0][2].text, "0.0021");
  EXPECT_EQ(table->rows[0][3].text, "large_angle 0.0021, attitude 1e-06");
}

}  // namespace
}  // namespace attest
