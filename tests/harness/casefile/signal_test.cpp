#include "harness/casefile/signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "tests/harness/times.hpp"

namespace attest {
namespace {

constexpr Span in_ticks(double amount) { return {amount, Span::In::ticks}; }
constexpr Span in_seconds(double amount) { return {amount, Span::In::seconds}; }

// 1 s of a 100 Hz loop.
const Timeline one_second{Rate::hz(100), ms(1000)};

double at(const Signal& signal, Nanoseconds time) { return Sampler(signal, one_second).at(time); }

TEST(Span, IsInTicksOrSeconds) {
  EXPECT_EQ(in_ticks(3).on(Rate::hz(100)), ms(30));
  EXPECT_EQ(in_ticks(2.5).on(Rate::hz(100)), ms(25));
  EXPECT_EQ(in_ticks(1).on(Rate::hz(333)), Rate::hz(333).tick(1));
  EXPECT_EQ(in_seconds(0.25).on(Rate::hz(333)), ms(250));
  EXPECT_EQ(in_seconds(1e9).on(Rate::hz(333)), std::chrono::seconds(1'000'000'000));
}

TEST(Span, CountsTheTicksThatBeginInIt) {
  EXPECT_EQ(tick_count(in_ticks(7), Rate::hz(333)), 7);
  EXPECT_EQ(tick_count(in_seconds(1), Rate::hz(333)), 333);
  EXPECT_EQ(tick_count(in_seconds(0.011), Rate::hz(100)), 2);
}

TEST(Signal, StepAndRampBeginAndEndAtTheirTimes) {
  const Step step{1, 2, in_ticks(5)};
  EXPECT_EQ(at(step, ms(50) - Nanoseconds(1)), 1);
  EXPECT_EQ(at(step, ms(50)), 2);
  const Ramp ramp{1, 2, in_ticks(5), in_seconds(0.15)};
  EXPECT_EQ(at(ramp, ms(50)), 1);
  EXPECT_DOUBLE_EQ(at(ramp, ms(75)), 1.25);
  EXPECT_EQ(at(ramp, ms(150)), 2);
  EXPECT_EQ(at(ramp, ms(900)), 2);
}

// One time is in ticks, the other in seconds, so their order depends on the rate.
TEST(Signal, ARampThatEndsBeforeItBeginsIsAStep) {
  const Ramp ramp{1, 2, in_ticks(50), in_seconds(0.1)};
  EXPECT_EQ(at(ramp, ms(300)), 1);
  EXPECT_EQ(at(ramp, ms(501)), 2);
}

TEST(Signal, Sine) {
  const Sine sine{1, 2, 0, {2, Frequency::In::cycles}};
  EXPECT_DOUBLE_EQ(at(sine, ms(0)), 1);
  EXPECT_NEAR(at(sine, ms(125)), 3, 1e-12);
  const Sine shifted{1, 2, 90, {2, Frequency::In::hertz}};
  EXPECT_NEAR(at(shifted, ms(0)), 3, 1e-12);
  EXPECT_NEAR(at(shifted, ms(500)), 3, 1e-12);
}

// 1 to 3 cycles a second over one second: 2 cycles in all, and faster at the end.
TEST(Signal, Chirp) {
  const Chirp chirp{0, 1, {1, Frequency::In::hertz}, {3, Frequency::In::cycles}};
  EXPECT_NEAR(at(chirp, ms(1000)), 0, 1e-9);
  EXPECT_NEAR(at(chirp, ms(500)), std::sin(2 * std::numbers::pi * 0.75), 1e-9);
}

TEST(Signal, SamplesHoldOrConnect) {
  Samples samples{{in_ticks(10), in_ticks(20), in_ticks(30)}, {1, 2, 4}, false};
  EXPECT_EQ(at(samples, ms(0)), 1);
  EXPECT_EQ(at(samples, ms(200) - Nanoseconds(1)), 1);
  EXPECT_EQ(at(samples, ms(200)), 2);
  EXPECT_EQ(at(samples, ms(999)), 4);
  samples.linear = true;
  EXPECT_EQ(at(samples, ms(0)), 1);
  EXPECT_DOUBLE_EQ(at(samples, ms(250)), 3);
  EXPECT_EQ(at(samples, ms(300)), 4);
  EXPECT_EQ(at(samples, ms(999)), 4);
}

RandomWalk any_walk() {
  RandomWalk walk;
  walk.seed = *rc::gen::arbitrary<std::uint64_t>();
  walk.step = *rc::gen::inRange(0, 500) / 100.0;
  walk.min = -1;
  walk.max = 0.5;
  walk.every = in_ticks(*rc::gen::inRange(1, 20));
  return walk;
}

RC_GTEST_PROP(Signal, ARandomWalkStaysInItsBoundsAndMovesByItsStep, ()) {
  const RandomWalk walk = any_walk();
  const Sampler sampler(walk, one_second);
  double last = sampler.at(ms(0));
  RC_ASSERT(last == walk.start);
  for (int tick = 0; tick < 100; ++tick) {
    const double value = sampler.at(one_second.rate.tick(tick));
    RC_ASSERT(value >= walk.min);
    RC_ASSERT(value <= walk.max);
    RC_ASSERT(std::abs(value - last) <= walk.step);
    const bool may_move = tick % static_cast<int>(walk.every.amount) == 0;
    RC_ASSERT(may_move || value == last);
    last = value;
  }
}

TEST(Signal, ARandomWalkMovesAtTheSameTicksAtEveryRate) {
  RandomWalk walk{3, 0, 0.1, -1, 1, in_ticks(7)};
  const auto values = [&](const Rate& rate) {
    const Sampler sampler(walk, {rate, rate.tick(1000)});
    std::vector<double> list;
    for (int k = 0; k < 1000; ++k) list.push_back(sampler.at(rate.tick(k)));
    return list;
  };
  for (const Rate& rate : standard_rates()) EXPECT_EQ(values(rate), values(Rate::hz(250)));
}

Quaternion by_tilt(double tilt_deg, double azimuth_deg, double yaw_deg) {
  return attitude_from(Angles::tilt_azimuth_yaw, {tilt_deg, azimuth_deg, yaw_deg});
}

TEST(Attitude, ComponentsOfPicturedAngles) {
  const double half = std::sqrt(0.5);
  const auto expect = [](const Quaternion& q, double w, double x, double y, double z) {
    EXPECT_NEAR(q.w, w, 1e-15);
    EXPECT_NEAR(q.x, x, 1e-15);
    EXPECT_NEAR(q.y, y, 1e-15);
    EXPECT_NEAR(q.z, z, 1e-15);
  };
  expect(by_tilt(0, 0, 0), 1, 0, 0, 0);
  expect(by_tilt(90, 0, 0), half, half, 0, 0);   // roll right
  expect(by_tilt(90, 90, 0), half, 0, half, 0);  // pitch up
  expect(by_tilt(0, 33, 90), half, 0, 0, half);  // yaw clockwise
  // First the yaw turns the nose to the east. Then the vehicle tilts to the east about north, an
  // axis of the world, so the nose points down.
  expect(by_tilt(90, 0, 90), 0.5, 0.5, -0.5, 0.5);
}

// The rotation matrix of the aerospace sequence, as textbooks print it (B. Stevens and F. Lewis,
// Aircraft Control and Simulation, the transpose of their eq. 1.4-9).
RC_GTEST_PROP(Attitude, EulerAnglesAreTheAerospaceSequence, ()) {
  const auto degrees = [] { return *rc::gen::inRange(-1800, 1800) / 10.0; };
  const double roll_deg = degrees(), pitch_deg = degrees(), yaw_deg = degrees();
  const Quaternion q = attitude_from(Angles::roll_pitch_yaw, {roll_deg, pitch_deg, yaw_deg});
  const double r = roll_deg * std::numbers::pi / 180, p = pitch_deg * std::numbers::pi / 180,
               y = yaw_deg * std::numbers::pi / 180;
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-12; };
  RC_ASSERT(near(q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z, std::cos(p) * std::cos(y)));
  RC_ASSERT(near(2 * (q.x * q.y + q.w * q.z), std::cos(p) * std::sin(y)));
  RC_ASSERT(near(2 * (q.x * q.z - q.w * q.y), -std::sin(p)));
  RC_ASSERT(near(2 * (q.y * q.z + q.w * q.x), std::sin(r) * std::cos(p)));
  RC_ASSERT(near(q.w * q.w - q.x * q.x - q.y * q.y + q.z * q.z, std::cos(r) * std::cos(p)));
  RC_ASSERT(near(2 * (q.x * q.y - q.w * q.z),
                 std::sin(r) * std::sin(p) * std::cos(y) - std::cos(r) * std::sin(y)));
}

// The tilt is that of the thrust axis, for every yaw: cos(tilt) is the lower right of R(q).
RC_GTEST_PROP(Attitude, TiltIsTheAngleOfTheThrustAxis, ()) {
  const double tilt = *rc::gen::inRange(0, 1800) / 10.0;
  const Quaternion q = by_tilt(tilt, *rc::gen::inRange(0, 360), *rc::gen::inRange(-180, 180));
  const double down_down = q.w * q.w - q.x * q.x - q.y * q.y + q.z * q.z;
  RC_ASSERT(std::abs(down_down - std::cos(tilt * std::numbers::pi / 180)) < 1e-12);
}

}  // namespace
}  // namespace attest
