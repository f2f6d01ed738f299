#include <cmath>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "controller/cascade/attitude_law.hpp"
#include "tests/controller/generators.hpp"

namespace attest::cascade {
namespace {

using test::uniform;
using Q = Quaternion<double>;
using Vector = Vector3<double>;

constexpr double epsilon_rad = 2e-6;  // the step's error in sin(angle / 2), at angles of 0.02 rad

Q turn_about_x(double angle) { return rotation_about(Vector(angle, 0, 0)); }
double angle_about_x(const Q& q) { return 2 * std::atan2(q[1], q[0]); }

// A model at rest, in the frame of the world.
struct Model : ReferenceModel<double> {
  explicit Model(double natural_rad_s, double feed_forward = 1, double limit_rad_s = 0) {
    set_gains({natural_rad_s, feed_forward, limit_rad_s});
    attitude = start(attitude);
  }

  void move(const Q& q_WD, double elapsed_s, double yaw_rate = NAN) {
    attitude = follow(attitude, q_WD, yaw_rate, std::uint64_t(std::lround(elapsed_s * 1e6)));
  }

  // What is fed forward to a body in the model's attitude.
  Vector rate() const { return feed_forward(Vector::Zero(), attitude, attitude); }

  Q attitude = identity<double>();
};

// A critically damped system of second order has the step response 1 - (1 + W t) exp(-W t), and its
// rate is W^2 t exp(-W t), however the time is divided. For small angles the model is that system.
RC_GTEST_PROP(ReferenceModel, IsCriticallyDampedForSmallAngles, ()) {
  const double natural = *uniform(5, 60), step = *uniform(-0.02, 0.02);
  Model model(natural);
  double time = 0;
  for (int i = 0; i < 12; ++i) {
    const double elapsed = 1e-6 * *rc::gen::inRange(1000, 60000);
    model.move(turn_about_x(step), elapsed);
    time += elapsed;
    const double left = (1 + natural * time) * std::exp(-natural * time);
    RC_ASSERT(std::abs(angle_about_x(model.attitude) - step * (1 - left)) < epsilon_rad);
    const double rate = natural * natural * time * std::exp(-natural * time) * step;
    RC_ASSERT(std::abs(model.rate()[0] - rate) < natural * epsilon_rad);
  }
}

// After a long time it has turned by twice the sine of half the angle: by 2 rad at half a turn.
RC_GTEST_PROP(ReferenceModel, TurnsByTwiceTheSineOfHalfTheAngleInALongTime, ()) {
  const double angle = *uniform(-3.1, 3.1);
  Model model(50);
  model.move(turn_about_x(angle), 30);
  RC_ASSERT(std::abs(angle_about_x(model.attitude) - 2 * std::sin(angle / 2)) < 1e-6);
  RC_ASSERT(model.rate().norm() < 1e-9);
}

// About the world's z axis, which a tilted model has elsewhere.
RC_GTEST_PROP(ReferenceModel, AYawRateTurnsItAboutTheVertical, ()) {
  const Q tilted = turn_about_x(*uniform(-1, 1));
  const double yaw_rate = *uniform(-2, 2), elapsed = *uniform(0.001, 0.5);
  Model model(0.1);
  model.attitude = model.start(tilted);
  model.move(tilted, elapsed, yaw_rate);
  const Q expected = product(yaw_rotation(yaw_rate * elapsed), tilted);
  RC_ASSERT((model.attitude - expected).norm() < 1e-5);
}

TEST(ReferenceModel, FeedsTheYawRateForwardWhateverItsShare) {
  Model model(50, 0);
  model.move(identity<double>(), 0.004, 0.7);
  EXPECT_NEAR((model.rate() - Vector(0, 0, 0.7)).norm(), 0, 1e-12);
  model.move(identity<double>(), 0.004, INFINITY);
  EXPECT_EQ(model.rate(), Vector::Zero());
}

// While a yaw rate is commanded, the model does not feed its own yaw forward.
TEST(ReferenceModel, FeedsNoYawOfItsOwnForwardDuringACommandedOne) {
  const Q turned = yaw_rotation(0.3);
  for (const double still : {0.0, 1e-8, double(NAN)}) {
    Model model(20);
    model.move(turned, 0.02, still);
    EXPECT_GT(model.rate()[2], 1) << still;
  }
  Model model(20);
  model.move(turned, 0.02, 0.5);
  EXPECT_NEAR(model.rate()[2], 0.5, 1e-9);
}

TEST(ReferenceModel, LimitsTheShareOfItsRate) {
  const Q turned = turn_about_x(0.5);
  Model free(20), half(20, 0.5), limited(20, 0.5, 0.3);
  for (Model* model : {&free, &half, &limited}) model->move(turned, 0.05);
  EXPECT_GT(free.rate()[0], 1);
  EXPECT_NEAR(half.rate()[0], free.rate()[0] / 2, 1e-12);
  EXPECT_NEAR(limited.rate()[0], 0.3, 1e-12);
}

// The law with the model, 4 ms between setpoints.
class LawWithModel : public ::testing::Test {
 protected:
  LawWithModel() {
    law_.set_gains(
        attitude_unit_gains<double>(default_parameters(attitude_parameters(), Profile::px4_v1_18)));
  }
  void take(const Q& q_WD, double yaw_rate = NAN) {
    const std::uint64_t now = last_us_ + 4000;
    law_.set_setpoint(q_WD, yaw_rate, now, last_us_);
    last_us_ = now;
  }
  Vector rates(const Q& q_WB = identity<double>()) { return law_.update(q_WB); }

  AttitudeLaw<double> law_{true};
  std::uint64_t last_us_ = 0;
};

TEST_F(LawWithModel, TakesTheFirstSetpointAtOnceWithoutItsYawRate) {
  take(turn_about_x(0.1), 1.0);
  EXPECT_NEAR((rates() - Vector(4 * 2 * std::sin(0.05), 0, 0)).norm(), 0, 1e-6);
}

TEST_F(LawWithModel, StandsStillWithoutASetpoint) {
  take(identity<double>());
  take(turn_about_x(0.1));
  const Vector before = rates();
  EXPECT_GT(before[0], 0);
  EXPECT_EQ(rates(), before);
}

TEST_F(LawWithModel, TurnsWithTheEstimator) {
  take(turn_about_x(0.2));
  take(turn_about_x(0.4));
  const Q delta = yaw_rotation(0.6);
  const Vector before = rates();
  law_.adapt_setpoint(delta);
  EXPECT_LT((rates(delta) - before).norm(), 1e-6);
}

TEST_F(LawWithModel, KeepsANaNForEver) {
  take(identity<double>());
  take(Q(1, NAN, 0, 0));
  for (int i = 0; i < 3; ++i) take(identity<double>());
  EXPECT_TRUE(std::isnan(rates()[0]));
}

}  // namespace
}  // namespace attest::cascade
