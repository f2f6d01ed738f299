// The plant's loop on a clock whose lateness the test gives.
#include "harness/realtime/live_plant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/realtime/flights.hpp"
#include "tests/harness/realtime/scripted_clock.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::Optional;

class StillPlant final : public Plant {
 public:
  void reset(const PlantState& start) override { state_ = start; }
  void command(std::span<const double>) override {}
  void set_wind(const Vector3&) override {}
  void set_centre_of_mass(const Vector3&) override {}
  std::optional<Divergence> advance(Nanoseconds) override { return std::nullopt; }
  const PlantState& state() const override { return state_; }

 private:
  PlantState state_;
};

// At 1 kHz, for 8 ms.
class LivePlantTest : public testing::Test {
 protected:
  LivePlantRecord run() {
    LivePlantPlan plan{Rate::hz(1000), ms(8), 4, {}, estimator_, {}, landing_times_};
    plan.land_detector.emplace(case_, Rate::hz(1000));
    LivePlant live(task_, std::move(plan), clock_, links_);
    live.run();
    return live.take_record();
  }

  std::optional<Rate> estimator_;
  std::vector<Nanoseconds> landing_times_;
  Vehicle vehicle_ = test::quad_vehicle();
  Case case_ = test::hover_case(0.008);
  StillPlant plant_;
  PlantTask task_{case_, Rate::hz(1000), vehicle_, plant_};
  ScriptedClock clock_;
  Links links_;
};

TEST_F(LivePlantTest, StepsWhoseTimeHasPassedAreMadeUpInOneGo) {
  clock_.latency = [](Nanoseconds due) { return due == ms(3) ? us(2500) : ns(0); };
  const LivePlantRecord record = run();
  EXPECT_EQ(record.steps(), 8u);
  EXPECT_EQ(record.late_steps, 2u);
  EXPECT_EQ(record.latency.max(), us(2500));
}

// The step of 3 ms runs at 3.5 ms. A command of 3.2 ms is there by then, but belongs to the next
// step.
TEST_F(LivePlantTest, ACommandFromAfterTheTimeOfAStepIsForTheNext) {
  clock_.latency = [](Nanoseconds due) { return due == ms(3) ? us(500) : ns(0); };
  clock_.before_waiting = [&](Nanoseconds due) {
    if (due == ms(2)) links_.commands.write({0, us(1500), {}, 0, true});
    if (due == ms(3)) links_.commands.write({1, us(3200), {}, 0, true});
  };
  EXPECT_THAT(run().commanded,
              ElementsAre(Optional(ms(2)), Optional(ms(4)), std::nullopt, std::nullopt));
}

TEST_F(LivePlantTest, ASampleOfTheEstimatorIsPublishedWithTheStateOfItsTime) {
  estimator_ = Rate::hz(500);
  std::vector<Nanoseconds> published;
  const auto look = [&] {
    if (links_.published.try_acquire()) published.push_back(clock_.now());
  };
  clock_.before_waiting = [&](Nanoseconds) { look(); };
  run();
  EXPECT_THAT(published, ElementsAre(ms(0), ms(2), ms(4), ms(6)));
}

TEST_F(LivePlantTest, BothUnitsReceiveItsState) {
  run();
  for (UnitLinks* unit : {&links_.unit, &links_.attitude_unit}) {
    const LiveState* state = unit->states.read();
    ASSERT_NE(state, nullptr);
    EXPECT_EQ(state->time, ms(8));
  }
}

// It starts at rest on the floor, and the command of 2 ms lifts it off.
TEST_F(LivePlantTest, TheLandDetectorHasTimesOfItsOwn) {
  landing_times_ = {ms(0), ms(4)};
  case_.flight->start.on_floor = true;
  std::vector<bool> landed;
  clock_.before_waiting = [&](Nanoseconds due) {
    if (due == ms(1)) links_.commands.write({0, us(500), {}, 0.9f, true});
    const LandDetected* of_unit = links_.unit.landed.read();
    const LandDetected* of_attitude_unit = links_.attitude_unit.landed.read();
    ASSERT_EQ(of_unit == nullptr, of_attitude_unit == nullptr);
    if (of_unit == nullptr) return;
    EXPECT_EQ(*of_unit, *of_attitude_unit);
    landed.push_back(of_unit->landed);
  };
  run();
  EXPECT_THAT(landed, ElementsAre(true, false));
}

}  // namespace
}  // namespace attest
