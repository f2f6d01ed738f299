#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/conclusion.hpp"
#include "harness/report/report.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string page_of(const RunResult& run) { return html_report({run, std::nullopt, {}}); }

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST(HtmlReport, BeginsWithTheConclusion) {
  const std::string page = page_of(sample_run());
  EXPECT_THAT(page, HasSubstr("fail</p>"));
  const std::size_t conclusion = page.find(conclusion_text(sample_run()));
  EXPECT_THAT(page, HasSubstr("none: px4-v1.5.5, 4 groups fail"));
  EXPECT_LT(conclusion, page.find("class=\"matrix\""));
  EXPECT_THAT(page_of(passing_run()), HasSubstr("pass</p>"));
}

TEST(HtmlReport, HasARowForEachResult) {
  const RunResult run = sample_run();
  EXPECT_EQ(count(page_of(run), "<tr><td class=v-"), run.results.size());
}

TEST(HtmlReport, ShowsTheFirstDivergenceWithBits) {
  const std::string page = page_of(sample_run());
  EXPECT_THAT(page, HasSubstr("<td>483<td>17<td>68000<td>out/vehicle_rates_setpoint.yaw [rad/s]"
                              "<td>attitude law<td>-1.5 0xbfc00000<td>0.3 0x3e99999a<td>off by"));
}

TEST(HtmlReport, NeverInterpretsTextOfThePort) {
  const std::string page = page_of(sample_run());
  EXPECT_THAT(page, HasSubstr("acme &lt;fc&gt; &amp; "));
  EXPECT_THAT(page, HasSubstr("&lt;/failure&gt;]]&gt;&lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_EQ(count(page, "</script>"), 9u);
}

TEST(HtmlReport, TellsWhatACaseTests) {
  RunResult run = sample_run();
  run.whys["px4-v1.5.5/attitude/yaw_step"] = "A yaw </script> step.";
  EXPECT_THAT(page_of(run),
              HasSubstr(R"({"px4-v1.5.5/attitude/yaw_step":"A yaw \u003c/script> step."})"));
}

TEST(HtmlReport, NeedsNoOtherFile) {
  const std::string page = page_of(sample_run());
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr(" src=")));
  EXPECT_THAT(page, Not(HasSubstr("sourceMappingURL")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_EQ(count(page, "href="), 1u);  // the icon, which is empty
}

TEST(HtmlReport, KeepsTheNoticeOfDygraphs) {
  const std::string page = page_of(passing_run());
  EXPECT_THAT(page, HasSubstr("Dan Vanderkam"));
  EXPECT_THAT(page, HasSubstr("THE SOFTWARE IS PROVIDED &quot;AS IS&quot;"));
  EXPECT_THAT(page, HasSubstr("Dygraph="));
}

TEST(HtmlReport, TheMatrixHasWorstVerdictCountsAndHeadroom) {
  const std::string page = page_of(sample_run());
  EXPECT_THAT(page, HasSubstr("<caption>px4-v1.5.5: vectors by group and rate [Hz]</caption>"));
  EXPECT_THAT(page, HasSubstr(">attitude</th><td class=\"number v-fail\"><b>\u2717</b> 1/2<br>"
                              "<small>12\u00d7</small></td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number v-crash\"><b>\u2738</b> 0/3</td>"));
}

TEST(HtmlReport, AProfileThatFailsComesBeforeOneThatPasses) {
  RunResult run = sample_run();
  run.results.insert(run.results.begin(), passed("attitude", "a", Rate::hz(250)));
  run.results.front().profile = "px4-v1.3.4";
  const std::string page = page_of(run);
  EXPECT_LT(page.find("<caption>px4-v1.5.5"), page.find("<caption>px4-v1.3.4"));
}

TEST(HtmlReport, CountsFailuresWithoutADivergenceByReason) {
  RunResult run = sample_run();
  run.results.push_back(
      *std::find_if(run.results.begin(), run.results.end(),
                    [](const VectorResult& result) { return result.verdict == Verdict::timeout; }));
  EXPECT_THAT(page_of(run), HasSubstr("</b> 2 timeout: no answer within 10 s"));
  EXPECT_THAT(page_of(passing_run()), Not(HasSubstr("Failures without a deviation")));
}

TEST(HtmlReport, IsTheSameForTheSameRun) {
  EXPECT_EQ(page_of(sample_run()), page_of(sample_run()));
}

}  // namespace
}  // namespace attest
