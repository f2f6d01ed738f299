// When a topic's samples reach the unit, and which values it sees in between. battery_status
// represents all topics.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::AnyOf;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* counting =
    "scale = { signal = \"ramp\", from = 0, to = 10, end_ticks = 10 }\n";

Trace battery(const std::string& lines, const Rate& rate = Rate::hz(250)) {
  return stimulate(case_of("[battery_status]\n" + lines), rate);
}

std::vector<std::size_t> published_at(const Trace& trace) {
  std::vector<std::size_t> ticks;
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    if (trace.samples[tick].in.updated & ATTEST_UPDATED_BATTERY_STATUS) ticks.push_back(tick);
  }
  return ticks;
}

std::vector<float> scales(const Trace& trace) {
  std::vector<float> values;
  for (const Sample& sample : trace.samples) values.push_back(sample.in.battery_status.scale);
  return values;
}

TEST(Publication, WhatNeverChangesIsPublishedWithTheFirstTick) {
  EXPECT_THAT(published_at(battery("scale = 0.5\n")), ElementsAre(0));
  EXPECT_THAT(scales(battery("scale = 0.5\n")), Each(0.5f));
}

TEST(Publication, WhatVariesIsPublishedAtEveryTick) {
  const Trace trace = battery(counting);
  EXPECT_THAT(published_at(trace), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(scales(trace), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
}

TEST(Publication, EveryTickOrNever) {
  EXPECT_EQ(published_at(battery("publish = \"every_tick\"\n")).size(), 10u);
  const Trace never = battery("scale = 0.5\npublish = \"never\"\n");
  EXPECT_THAT(published_at(never), IsEmpty());
  EXPECT_THAT(scales(never), Each(0.0f));
}

TEST(Publication, PeriodicShowsTheLastSampleInBetween) {
  const Trace trace = battery(std::string(counting) + "period_ticks = 3\nphase_ticks = 2\n");
  EXPECT_THAT(published_at(trace), ElementsAre(2, 5, 8));
  EXPECT_THAT(scales(trace), ElementsAre(0, 0, 2, 2, 2, 5, 5, 5, 8, 8));
}

TEST(Publication, AtGivenTimes) {
  const Trace trace = battery(std::string(counting) + "publish_at_ticks = [1, 1.5, 6]\n");
  // The next tick sees a sample that lies between ticks, with the value at the sample's time.
  EXPECT_THAT(published_at(trace), ElementsAre(1, 2, 6));
  EXPECT_THAT(scales(trace), ElementsAre(0, 1, 1.5, 1.5, 1.5, 1.5, 6, 6, 6, 6));
}

TEST(Publication, ByARateOfItsOwn) {
  // 100 Hz at 250 Hz ticks: at 0, 2.5, 5 and 7.5 ticks.
  const Trace slower = battery(std::string(counting) + "rate_hz = 100\n");
  EXPECT_THAT(published_at(slower), ElementsAre(0, 3, 5, 8));
  EXPECT_THAT(scales(slower), ElementsAre(0, 0, 0, 2.5, 2.5, 5, 5, 5, 7.5, 7.5));
  const Trace faster = battery(std::string(counting) + "period_s = 0.003\n");
  EXPECT_THAT(published_at(faster), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(scales(faster), ElementsAre(0, .75f, 1.5f, 3, 3.75f, 4.5f, 6, 6.75f, 7.5f, 9));
}

// In ticks it is the same at every rate, also where a tick is no whole number of nanoseconds.
TEST(Publication, InTicksIsTheSameAtEveryRate) {
  const std::string lines =
      "scale = { signal = \"step\", from = 1, to = 2, at_ticks = 7 }\n"
      "period_ticks = 4\nphase_ticks = 3\n";
  for (const Rate& rate : standard_rates()) {
    const Trace trace = battery(lines, rate);
    EXPECT_THAT(published_at(trace), ElementsAre(3, 7)) << rate.to_string();
    EXPECT_THAT(scales(trace), ElementsAre(0, 0, 0, 1, 1, 1, 1, 2, 2, 2)) << rate.to_string();
  }
}

TEST(Publication, ASampleWaitsForTheNextTickThatHappens) {
  const Trace trace =
      stimulate(case_of("[unit]\ndrop_ticks = [0, 4, 5]\n[battery_status]\npublish_at_ticks = [4]\n"
                        "[vehicle_status]\nis_vtol = true\n"),
                Rate::hz(250));
  ASSERT_EQ(trace.samples.size(), 7u);
  // The tick after the dropped ones is the fourth that happens: 1, 2, 3, 6.
  EXPECT_THAT(published_at(trace), ElementsAre(3));
  EXPECT_EQ(trace.samples[3].in.timestamp, 5'024'000u);
  EXPECT_NE(trace.samples[0].in.updated & ATTEST_UPDATED_VEHICLE_STATUS, 0u);
}

TEST(Publication, ADelayedSampleIsSeenLaterWithTheValueOfItsRelease) {
  const Trace trace = battery(std::string(counting) + "period_ticks = 3\ndelay_ticks = 2\n");
  EXPECT_THAT(published_at(trace), ElementsAre(2, 5, 8));
  EXPECT_THAT(scales(trace), ElementsAre(0, 0, 0, 0, 0, 3, 3, 3, 6, 6));
}

TEST(Publication, ReleasesMayBeDroppedOrLate) {
  EXPECT_THAT(
      published_at(battery(std::string(counting) + "period_ticks = 2\ndrop_samples = [1, 3]\n")),
      ElementsAre(0, 4, 8));
  // Each sample is late by its own random part of a period.
  const Trace late = battery(std::string(counting) + "rate_hz = 125\njitter = 0.9\nseed = 3\n");
  EXPECT_THAT(published_at(battery(std::string(counting) + "rate_hz = 125\n")),
              ElementsAre(0, 2, 4, 6, 8));
  EXPECT_THAT(published_at(late), ElementsAre(AnyOf(1, 2), AnyOf(3, 4), AnyOf(5, 6), AnyOf(7, 8)))
      << "the last comes after the end";
}

TEST(Publication, AFieldThatVariesPublishesTheWholeTopic) {
  const Trace trace = stimulate(
      case_of("[vehicle_attitude_setpoint]\nq_d = { tilt_deg = { signal = \"ramp\", from = 0, "
              "to = 9, end_ticks = 9 } }\nthrust = 0.25\n"),
      Rate::hz(250));
  for (const Sample& sample : trace.samples) {
    EXPECT_NE(sample.in.updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT, 0u);
    EXPECT_EQ(sample.in.vehicle_attitude_setpoint.thrust, 0.25f);
  }
}

}  // namespace
}  // namespace attest
