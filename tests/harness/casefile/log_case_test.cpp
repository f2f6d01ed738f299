// A case of a log gives a unit what the log has, at the times of the log.
#include "harness/casefile/log_case.hpp"

#include <cstdint>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>

#include "harness/casefile/stimulus.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr std::uint64_t begin_us = 12'345'678;

// Ten ticks, 20 ms and once 60 ms apart. The setpoint is new at each third one, the mode once, and
// the battery has no sample.
Trace flown() {
  Trace log;
  log.source = "logs/my flight.ulg";
  log.present = channels_of(Module::mc_att_control, "in/");
  Sample sample{};
  for (std::size_t tick = 0; tick < 10; ++tick) {
    sample.in.timestamp = begin_us + 20'000 * tick + (tick > 7 ? 40'000 : 0);
    sample.in.updated = tick == 0 ? ATTEST_UPDATED_VEHICLE_CONTROL_MODE : 0;
    sample.in.vehicle_control_mode.flag_control_attitude_enabled = 1;
    const auto value = static_cast<float>(tick);
    const float q[] = {0.1f * value, -0.0f, 1.0f / 3, 1e-30f * value};
    std::memcpy(sample.in.control_state.q, q, sizeof q);
    sample.in.control_state.roll_rate = tick == 5 ? std::numeric_limits<float>::infinity() : value;
    if (tick % 3 == 1) {
      sample.in.updated |= ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
      sample.in.vehicle_attitude_setpoint.q_d[2] = 0.7f * value;
      sample.in.vehicle_attitude_setpoint.thrust = 0.3f;
    }
    log.samples.push_back(sample);
  }
  log.parameters = {{0, "MC_ROLL_P", 5.5f}, {0, "SYS_OTHER", 1}, {4, "MC_YAW_P", 3.1f}};
  log.samples[4].in.updated |= ATTEST_UPDATED_PARAMETER_UPDATE;
  return log;
}

LogCase made_of(const Trace& log, const LogPart& part = {}) {
  auto made = case_of_log(log, "px4-v1.5.5", part, {"a note"});
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

Case parsed(const LogCase& made, std::string_view profile = "px4-v1.5.5") {
  const CaseFiles files;
  auto the_case = parse_case(files.write(log_case_group, made.name, made.toml, profile));
  EXPECT_TRUE(the_case) << the_case.error().message;
  return *std::move(the_case);
}

std::string error_of(const Trace& log, const LogPart& part) {
  const auto made = case_of_log(log, "px4-v1.5.5", part, {});
  return made ? "" : made.error().message;
}

// What the case gives a unit whose ticks are those of the log.
Trace given_at_times_of(const Trace& log, std::size_t first, const Case& the_case) {
  Trace given;
  Stimulus stimulus(the_case, Rate::hz(250));
  Sample sample{};
  const std::uint64_t begin = log.samples[first].in.timestamp;
  for (std::size_t tick = first; tick < log.samples.size(); ++tick) {
    const auto time = static_cast<std::int64_t>(log.samples[tick].in.timestamp - begin) * 1000;
    stimulus.tick(tick - first, Nanoseconds(time), sample, given.parameters);
    given.samples.push_back(sample);
  }
  return given;
}

void expect_the_same(const Sample& given, const Sample& logged,
                     Module module = Module::mc_att_control) {
  Sample a = given, b = logged;
  for (Sample* sample : {&a, &b}) {
    sample->in.updated &= ~std::uint32_t{ATTEST_UPDATED_PARAMETER_UPDATE};
  }
  for (const Channel& channel : channels()) {
    if (channel.is_output() || channel.module != module) continue;
    EXPECT_EQ(value_of(channel, a), value_of(channel, b)) << channel.name;
  }
}

TEST(LogCase, GivesTheInputsOfTheLogAtItsTimes) {
  const Trace log = flown();
  const Trace given = given_at_times_of(log, 0, parsed(made_of(log)));
  for (std::size_t tick = 0; tick < log.samples.size(); ++tick) {
    SCOPED_TRACE(tick);
    expect_the_same(given.samples[tick], log.samples[tick]);
  }
  // MC_YAW_P has its default before.
  EXPECT_THAT(given.parameters, ElementsAre(ParameterChange{0, "MC_ROLL_P", 5.5f},
                                            ParameterChange{0, "MC_YAW_P", 2.8f},
                                            ParameterChange{4, "MC_YAW_P", 3.1f}));
}

TEST(LogCase, BeginsWithWhatWasKnownBeforeThePart) {
  Trace log = flown();
  const LogCase made = made_of(log, {0.06, 0.2});
  EXPECT_EQ(made.samples, 5u);
  const Trace given = given_at_times_of(log, 3, parsed(made));
  log.samples[3].in.updated =
      ATTEST_UPDATED_VEHICLE_CONTROL_MODE | ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
  for (std::size_t tick = 3; tick < 8; ++tick) {
    SCOPED_TRACE(tick);
    expect_the_same(given.samples[tick - 3], log.samples[tick]);
  }
}

// Ten ticks of an attitude unit, 4 ms apart: an estimator reset at the third and at the seventh, a
// setpoint at each third one.
Trace flown_by_attitude_unit() {
  Trace log;
  log.source = "logs/my flight.ulg";
  log.present = channels_of(Module::attitude_unit, "in/");
  log.parameters = {{0, "MC_YAW_WEIGHT", 0.5f}, {6, "MC_ROLL_P", 6.0f}};
  Sample sample;
  for (std::size_t tick = 0; tick < 10; ++tick) {
    attest_attitude_inputs& in = sample.attitude_in;
    in.timestamp = begin_us + 4000 * tick;
    in.updated = tick == 0 ? ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS : 0;
    in.vehicle_status.armed = 1;
    in.vehicle_status.armed_time = begin_us - 2'000'001;
    in.vehicle_attitude.timestamp = in.timestamp - 100;
    in.vehicle_attitude.timestamp_sample = in.timestamp - 500 - tick;
    in.vehicle_attitude.q[1] = 0.1f * static_cast<float>(tick);
    in.vehicle_attitude.quat_reset_counter = tick < 3 ? 255 : tick < 7 ? 0 : 1;
    if (tick % 3 == 1) {
      in.updated |= ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
      in.vehicle_attitude_setpoint.timestamp = in.timestamp - 33 * tick;
      in.vehicle_attitude_setpoint.yaw_sp_move_rate = 0.3f * static_cast<float>(tick);
    }
    log.samples.push_back(sample);
  }
  return log;
}

// A unit that starts with the part knows of no earlier reset.
TEST(LogCase, OfAUnitHasTheTimesOfTheLogAndCountsResetsFromItsBegin) {
  const Trace log = flown_by_attitude_unit();
  for (const std::size_t first : {std::size_t{0}, std::size_t{5}}) {
    const auto made = case_of_log(log, "px4-v1.16.0", {0.004 * static_cast<double>(first)}, {});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->step_topic, "vehicle_attitude");
    EXPECT_THAT(made->name, testing::EndsWith("_attitude_unit"));
    const Case the_case = parsed(*made, "px4-v1.16.0");
    EXPECT_EQ(the_case.module, Module::attitude_unit);
    const Trace given = given_at_times_of(log, first, the_case);
    for (std::size_t tick = first; tick < log.samples.size(); ++tick) {
      SCOPED_TRACE(tick);
      Sample logged = log.samples[tick];
      attest_attitude_inputs& in = logged.attitude_in;
      in.vehicle_attitude.quat_reset_counter = static_cast<std::uint8_t>(
          in.vehicle_attitude.quat_reset_counter -
          log.samples[first].attitude_in.vehicle_attitude.quat_reset_counter);
      if (tick == first && first > 0) {  // received before the part
        in.updated = ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS |
                     ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
      }
      if (tick < 1)
        in.vehicle_attitude_setpoint = given.samples[0].attitude_in.vehicle_attitude_setpoint;
      expect_the_same(given.samples[tick - first], logged, Module::attitude_unit);
    }
  }
}

TEST(LogCase, IsNamedAfterTheLogAndSaysWhatItIs) {
  const LogCase made = made_of(flown(), {0.02, 0.1});
  EXPECT_EQ(made.name, "my_flight_from_0_02s_to_0_1s");
  const Case the_case = parsed(made);
  EXPECT_THAT(the_case.why, HasSubstr("my flight.ulg, from 0.02 s to 0.1 s after"));
  EXPECT_THAT(the_case.why, HasSubstr("a note"));
  EXPECT_THAT(the_case.rates, testing::SizeIs(11));
  EXPECT_DOUBLE_EQ(made.duration_s, 0.08);
  EXPECT_EQ(made_of(flown()).name, "my_flight");
}

TEST(LogCase, HasConstantsWhereNothingChanges) {
  const std::string toml = made_of(flown()).toml;
  EXPECT_THAT(toml, HasSubstr("MC_ROLL_P = 5.5\n"));
  EXPECT_THAT(toml, HasSubstr("'q[2]' = 0.3333333"));
  EXPECT_THAT(toml, HasSubstr("[battery_status]\npublish = 'never'\n"));
  EXPECT_THAT(toml, HasSubstr("thrust = 0.30000001192092896\n"));
  EXPECT_THAT(toml, Not(HasSubstr("SYS_OTHER")));
}

TEST(LogCase, RefusesAPartThatIsEmptyOrBeyondTheLog) {
  const Trace log = flown();
  EXPECT_THAT(error_of(log, {0.1, 0.1}), HasSubstr("is empty"));
  EXPECT_THAT(error_of(log, {0.101, 0.119}), HasSubstr("has 0 samples"));
  EXPECT_THAT(error_of(log, {0.5}), HasSubstr("are from 0 to 0.244445 s"));
  EXPECT_THAT(error_of(log, {0, 0.3}), HasSubstr("beyond the log"));
  EXPECT_THAT(error_of(log, {-1}), HasSubstr("beyond the log"));
  EXPECT_EQ(error_of(log, {0, 0.244}), "");
}

TEST(LogCase, RefusesMoreTicksThanACaseMayHave) {
  Trace log = flown();
  log.samples.back().in.timestamp = begin_us + 120'000'000;
  EXPECT_THAT(error_of(log, {}), HasSubstr("is more than 1000000 ticks at 8000 Hz; choose at most "
                                           "125 s"));
  EXPECT_EQ(error_of(log, {0, 1}), "");
}

}  // namespace
}  // namespace attest
