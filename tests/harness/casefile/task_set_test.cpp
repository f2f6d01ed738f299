#include "harness/casefile/task_set.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* unit = "[task.unit]\nrate_hz = 250\nexecution_us = 76\npriority = 2\n";

Result<TaskSet> read(const std::string& text) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "tasks.toml";
  EXPECT_TRUE(write_file(path, text));
  return read_task_set(path);
}

std::string error_of(const std::string& text) {
  const auto set = read(text);
  return set ? "" : fmt::format("{}: {}", set.error().line, set.error().message);
}

TEST(TaskSet, IsRead) {
  const auto set = read(std::string("[task.estimator]\nrate_hz = 333\nexecution_us = [400, 500.5]\n"
                                    "priority = 3\ncpu = 1\nphase_us = 10\n") +
                        unit);
  ASSERT_TRUE(set) << set.error().to_string();
  ASSERT_EQ(set->tasks.size(), 2u);
  EXPECT_EQ(set->tasks[set->unit].name, "unit");
  EXPECT_EQ(set->tasks[set->unit].rate, Rate::hz(250));
  EXPECT_THAT(set->tasks[set->unit].execution, ElementsAre(us(76)));
  const ScheduledTask& estimator = set->tasks[set->estimator.value()];
  EXPECT_THAT(estimator.execution, ElementsAre(us(400), Nanoseconds(500'500)));
  EXPECT_EQ(estimator.cpu, 1);
  EXPECT_EQ(estimator.phase, us(10));
  EXPECT_FALSE(read(unit)->estimator);
}

TEST(TaskSet, AUnitTakesItsMeasuredExecutionTime) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "tasks.toml";
  const auto read_measured = [&](const std::string& text, const UnitExecution& measured) {
    EXPECT_TRUE(write_file(path, text));
    return read_task_set(path, measured);
  };
  const std::string without = "[task.unit]\nrate_hz = 250\npriority = 2\n";
  EXPECT_FALSE(read(without));
  for (const std::string& text : {std::string(unit), without}) {
    const auto set = read_measured(text, {{Module::mc_att_control, us(90)}});
    ASSERT_TRUE(set) << set.error().to_string();
    EXPECT_THAT(set->tasks[set->unit].execution, ElementsAre(us(90)));
  }
  EXPECT_THAT(read_measured(unit, {{Module::mc_att_control, ns(3)}})->tasks[0].execution,
              ElementsAre(us(1)));
  const auto wrong = read_measured(unit, {{Module::rate_unit, us(90)}});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("no execution time of the controller was measured"));
}

TEST(TaskSet, AMisspeltNameIsSuggested) {
  const std::string rest = "rate_hz = 9\nexecution_us = 1\npriority = 1\n";
  EXPECT_THAT(error_of("[task.io]\n" + rest + "[task.uint]\n" + rest),
              HasSubstr("5: there is no [task.unit]; did you mean `unit`?"));
  EXPECT_THAT(error_of(unit + ("[task.estimater]\n" + rest)),
              HasSubstr("5: there is no [task.estimator]; did you mean `estimator`?"));
  EXPECT_TRUE(read(unit + ("[task.units]\n" + rest)));
}

TEST(TaskSet, MistakesHaveTheirLine) {
  EXPECT_THAT(error_of(""), HasSubstr("`task`"));
  EXPECT_THAT(error_of("[task.io]\nrate_hz = 1\nexecution_us = 1\npriority = 1\n"),
              HasSubstr("needs [task.unit]"));
  EXPECT_THAT(error_of(std::string(unit) + "cpu = 2\n"), HasSubstr("5: must be 0 or 1"));
  EXPECT_THAT(error_of(std::string(unit) + "phase_us = -1\n"), HasSubstr("5: must be from 0"));
  EXPECT_THAT(error_of(std::string(unit) + "prority = 1\n"), HasSubstr("5: unknown key"));
  EXPECT_THAT(error_of("[task.unit]\nrate_hz = 0\nexecution_us = 1\npriority = 1\n"),
              HasSubstr("2: "));
  EXPECT_THAT(error_of("[task.unit]\nrate_hz = 250\nexecution_us = 0.5\npriority = 1\n"),
              HasSubstr("3: must be from 1"));
  EXPECT_THAT(error_of("[task.unit]\nrate_hz = 250\nexecution_us = []\npriority = 1\n"),
              HasSubstr("3: is empty"));
}

TEST(TaskSet, NumbersThatDoNotFitAreRefused) {
  const std::string head = "[task.unit]\nrate_hz = 250\nexecution_us = 1\n";
  EXPECT_THAT(error_of(head + "priority = 4294967297\n"),
              HasSubstr("4: must be from -1000000 to 1000000"));
  EXPECT_THAT(error_of(std::string(unit) + "cpu = 4294967296\n"), HasSubstr("5: must be 0 or 1"));
}

constexpr const char* estimator =
    "[task.estimator]\nrate_hz = 333\nexecution_us = 400\npriority = 3\n";
constexpr const char* triggered =
    "[task.unit]\nexecution_us = 76\npriority = 2\ntrigger = \"estimator\"\n";

TEST(TaskSet, TheUnitMayBeReleasedByTheEstimator) {
  const auto set = read(std::string(triggered) + estimator);
  ASSERT_TRUE(set) << set.error().to_string();
  EXPECT_EQ(set->tasks[set->unit].released_by, set->estimator);
  EXPECT_EQ(set->tasks[set->unit].rate, Rate::hz(333));
  EXPECT_FALSE(set->tasks[*set->estimator].released_by);
}

TEST(TaskSet, ATriggerIsTheUnitsAndInPlaceOfARate) {
  EXPECT_THAT(error_of(triggered), HasSubstr("4: needs [task.estimator]"));
  EXPECT_THAT(error_of(std::string(triggered) + "rate_hz = 250\n" + estimator),
              HasSubstr("5: `trigger` is given too"));
  EXPECT_THAT(error_of(std::string(triggered) + "phase_us = 250\n" + estimator),
              HasSubstr("5: `trigger` is given too"));
  EXPECT_THAT(error_of(std::string(unit) + "[task.estimator]\nexecution_us = 1\npriority = 1\n"
                                           "trigger = \"unit\"\n"),
              HasSubstr("8: is for [task.unit] and [task.attitude_unit]"));
  EXPECT_THAT(error_of("[task.unit]\nexecution_us = 76\npriority = 2\ntrigger = \"gps\"\n"),
              HasSubstr("4: must be \"estimator\""));
}

TEST(TaskSet, OfTheCascadeHasBothUnits) {
  const std::string rate_unit = "[task.unit]\nrate_hz = 1000\nexecution_us = 1\npriority = 2\n";
  const std::string attitude = "[task.attitude_unit]\nexecution_us = 1\npriority = 1\n";
  EXPECT_THAT(error_of(rate_unit + attitude + "rate_hz = 2000\n"),
              HasSubstr("is slower than [task.attitude_unit]"));
  EXPECT_THAT(
      error_of("[task.unit]\ntrigger = \"estimator\"\nexecution_us = 1\npriority = 2\n" + attitude +
               "rate_hz = 250\n[task.estimator]\nrate_hz = 250\nexecution_us = 1\n"
               "priority = 3\n"),
      HasSubstr("the rate unit reads the gyro"));
  EXPECT_EQ(error_of(rate_unit + attitude +
                     "trigger = \"estimator\"\n[task.estimator]\nrate_hz = 250\n"
                     "execution_us = 1\npriority = 3\n"),
            "");
}

}  // namespace
}  // namespace attest
