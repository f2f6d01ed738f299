#include "harness/golden/decimate.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

Trace flown(std::size_t ticks) {
  Trace trace;
  trace.present = channels_of(Part::mc_att_control);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    Sample sample{};
    sample.in.timestamp = 1000 * (tick + 1);
    sample.in.updated = 1;
    trace.samples.push_back(sample);
  }
  trace.plant.resize(ticks);
  return trace;
}

std::vector<std::size_t> kept(const Trace& rows) {
  std::vector<std::size_t> ticks;
  for (const Sample& row : rows.samples) ticks.push_back(row.in.timestamp / 1000 - 1);
  return ticks;
}

TEST(Decimated, KeepsTheFirstTheRegularAndTheLast) {
  const auto ticks = kept(decimated(flown(1201)));
  EXPECT_THAT(ticks, testing::IsSupersetOf({0u, 1u, 2u, 3u, 100u, 200u, 1100u, 1200u}));
  EXPECT_EQ(ticks.size(), 4u + 12u);
  EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
}

TEST(Decimated, KeepsTheExtremesOfEveryOutput) {
  Trace trace = flown(2401);
  trace.samples[777].out.actuator_controls_0.control[2] = -1;
  trace.samples[1234].out.mc_att_ctrl_status.yaw_rate_integ = 0.5f;
  EXPECT_THAT(kept(decimated(trace)), testing::IsSupersetOf({777u, 1234u}));
}

TEST(Decimated, NaNIsNoExtreme) {
  Trace trace = flown(2401);
  trace.samples[777].out.actuator_controls_0.control[2] = std::nanf("");
  trace.samples[778].out.actuator_controls_0.control[2] = 1;
  const auto ticks = kept(decimated(trace));
  EXPECT_THAT(ticks, testing::Not(testing::Contains(777u)));
  EXPECT_THAT(ticks, testing::Contains(778u));
}

TEST(Decimated, AShortFlightIsKeptWhole) {
  EXPECT_THAT(kept(decimated(flown(3))), testing::ElementsAre(0u, 1u, 2u));
  EXPECT_THAT(kept(decimated(flown(1))), testing::ElementsAre(0u));
}

// Between two rows anything may have been new.
TEST(Decimated, SaysNothingOfWhatWasNew) {
  const Trace rows = decimated(flown(30));
  EXPECT_EQ(rows.present & channels_of(Part::mc_att_control, "in/updated."), ChannelSet());
  EXPECT_EQ(rows.samples[0].in.updated, 0u);
  EXPECT_TRUE(rows.plant.empty());
}

}  // namespace
}  // namespace attest
