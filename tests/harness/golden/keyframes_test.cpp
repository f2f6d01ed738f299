#include "harness/golden/keyframes.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

Trace flown(std::size_t ticks) {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    Sample sample{};
    sample.in.timestamp = 1000 * (tick + 1);
    sample.in.updated = 1;
    trace.samples.push_back(sample);
  }
  trace.plant.resize(ticks);
  return trace;
}

TEST(KeyframesOf, KeepsTheFirstTheRegularAndTheLast) {
  const auto ticks = keyframes_of(flown(1201));
  EXPECT_THAT(ticks, testing::IsSupersetOf({0u, 1u, 2u, 3u, 100u, 200u, 1100u, 1200u}));
  EXPECT_EQ(ticks.size(), 4u + 12u);
  EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
}

TEST(KeyframesOf, KeepsTheExtremesOfEveryOutput) {
  Trace trace = flown(2401);
  trace.samples[777].out.actuator_controls_0.control[2] = -1;
  trace.samples[1234].out.mc_att_ctrl_status.yaw_rate_integ = 0.5f;
  EXPECT_THAT(keyframes_of(trace), testing::IsSupersetOf({777u, 1234u}));
}

TEST(KeyframesOf, NaNIsNoExtreme) {
  for (const std::size_t nan : {0u, 777u}) {
    Trace trace = flown(2401);
    trace.samples[nan].out.actuator_controls_0.control[2] = std::nanf("");
    trace.samples[778].out.actuator_controls_0.control[2] = 1;
    trace.samples[779].out.actuator_controls_0.control[2] = -1;
    const auto ticks = keyframes_of(trace);
    EXPECT_THAT(ticks, testing::Not(testing::Contains(777u)));
    EXPECT_THAT(ticks, testing::IsSupersetOf({778u, 779u}));
  }
}

TEST(KeyframesOf, AShortFlightIsKeptWhole) {
  EXPECT_THAT(keyframes_of(flown(3)), testing::ElementsAre(0u, 1u, 2u));
  EXPECT_THAT(keyframes_of(flown(1)), testing::ElementsAre(0u));
}

}  // namespace
}  // namespace attest
