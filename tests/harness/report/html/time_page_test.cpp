#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/time_document.hpp"
#include "tests/harness/report/sample_run.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

TimeRun timed_run() {
  TimeRun run;
  run.port = "lib:./mine.so";
  run.times.steps = Histogram(us(3));
  run.times.vectors = {{passed("tpa", "ramp", Rate::hz(100)), {us(1), us(2)}, 512},
                       {passed("tpa", "ramp", Rate::hz(250)), {us(1), us(4)}, {}}};
  for (const VectorTimes& vector : run.times.vectors) {
    for (const Nanoseconds time : vector.steps) run.times.steps.add(time);
  }
  return run;
}

std::string page_of(const TimeRun& run) { return html_page(time_document(run)); }

TEST(TimePage, ComparesTheGroupsWithTheBudget) {
  TimeRun run = timed_run();
  run.budget_us = 3;
  const std::string page = page_of(run);
  EXPECT_THAT(page, HasSubstr("</span> fail</p>"));
  EXPECT_THAT(page, HasSubstr("1 of 4 steps took longer than 3 us, allowed 0"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number v-pass\"><b>\u2713</b> 2<br>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number v-fail\"><b>\u2717</b> 4<br>"));
  EXPECT_THAT(page, HasSubstr("\"text\":\"budget\""));
  EXPECT_THAT(page, HasSubstr("<td class=\"number\">512</td>"));
  run.allowed = 1;
  EXPECT_THAT(page_of(run), HasSubstr("</span> pass</p>"));
}

TEST(TimePage, WithoutABudgetIsAMeasurement) {
  EXPECT_THAT(page_of(timed_run()), HasSubstr("</span> measured</p>"));
}

}  // namespace
}  // namespace attest
