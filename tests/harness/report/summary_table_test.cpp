#include "harness/report/summary_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(SummaryTable, ACellSaysHowManyPassedOfThoseThatRan) {
  RunResult run;
  run.rates = {Rate::hz(50), Rate::hz(100), Rate::hz(1000, 3)};
  run.results = {with(Verdict::pass, "attitude", Rate::hz(50)),
                 with(Verdict::pass, "attitude", Rate::hz(50)),
                 with(Verdict::crash, "attitude", Rate::hz(100)),
                 with(Verdict::pass, "attitude", Rate::hz(100)),
                 with(Verdict::xfail, "attitude", Rate::hz(100)),
                 with(Verdict::skip, "b", Rate::hz(1000, 3))};
  EXPECT_EQ(render_table(run, {}),
            "group \\ Hz  50    100  1000/3  total\n"
            "attitude     2  1/2+1       -  3/4+1\n"
            "b            -      -     0+1    0+1\n"
            "total        2  1/2+1     0+1  3/4+2\n"
            "n/m: n of m vectors passed; +k: k counted apart\n");
}

TEST(SummaryTable, OneGroupNeedsNoTotal) {
  EXPECT_EQ(render_table(passing_run(), {}),
            "group \\ Hz  50  250  total\n"
            "attitude     3    3      6\n");
}

TEST(SummaryTable, ProfilesAreNamedWhenThereAreSeveral) {
  RunResult run = passing_run();
  run.results.back().profile = "px4-v1.12";
  EXPECT_THAT(render_table(run, {}), HasSubstr("\npx4-v1.5.5/attitude   3    2      5\n"
                                               "px4-v1.12/attitude    -    1      1\n"));
}

TEST(SummaryTable, ARateThatWasNotSelectedStillHasItsColumn) {
  RunResult run = passing_run();
  run.rates.clear();
  EXPECT_THAT(render_table(run, {}), HasSubstr("group \\ Hz  50  250  total\n"));
}

TEST(SummaryTable, BreaksIntoBlocksThatFit) {
  const std::string table = render_table(passing_run(), {.colour = false, .width = 17});
  EXPECT_EQ(table,
            "group \\ Hz  50\n"
            "attitude     3\n"
            "\n"
            "group \\ Hz  250\n"
            "attitude      3\n"
            "\n"
            "group \\ Hz  total\n"
            "attitude        6\n");
}

TEST(SummaryTable, ColoursDoNotMoveColumns) {
  RunResult run = passing_run();
  run.results.front().verdict = Verdict::fail;
  const std::string table = render_table(run, {.colour = true, .width = 0});
  EXPECT_THAT(table, HasSubstr("attitude    \x1b[31m2/3\x1b[0m    \x1b[32m3\x1b[0m"));
}

TEST(SummaryTable, IsEmptyWithoutResults) { EXPECT_THAT(render_table(RunResult{}, {}), IsEmpty()); }

}  // namespace
}  // namespace attest
