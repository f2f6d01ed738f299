// A log is read with little memory, so its steps do not depend on the order of samples in the file.
#include "harness/ulog/logged_steps.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/writer.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/ulog/crafted.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using ulog::raw;

// A log of a rate unit of v1.16 with a step each millisecond.
class LongLog : public testing::Test {
 protected:
  void SetUp() override {
    const std::string definitions[] = {
        "vehicle_angular_velocity:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;"
        "float[3] xyz_derivative;",
        "vehicle_rates_setpoint:uint64_t timestamp;float roll;float pitch;float yaw;"
        "float[3] thrust_body;",
        "vehicle_torque_setpoint:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;",
        "vehicle_control_mode:uint64_t timestamp;bool flag_control_rates_enabled;"};
    for (const std::string& topic : definitions) ASSERT_TRUE(writer_.define(topic));
    for (const std::string& topic : definitions) {
      const std::string name = topic.substr(0, topic.find(':'));
      ids_[name] = *writer_.subscribe(name);
    }
  }

  static std::uint64_t time_of(std::size_t step) { return 1'000'000 + 1000 * step; }

  template <typename... Values>
  void add(const char* topic, std::uint64_t time, Values... values) {
    ASSERT_TRUE(writer_.data(ids_.at(topic), raw(time, values...)));
  }
  void add_step(std::size_t step) {
    add("vehicle_angular_velocity", time_of(step), time_of(step) - 300, 0.0f, 0.0f, 0.0f, 0.0f,
        0.0f, 0.0f);
  }
  // The setpoint and the output of a step.
  void add_setpoint(std::size_t step) {
    add("vehicle_rates_setpoint", time_of(step) - 100, static_cast<float>(step), 0.0f, 0.0f, 0.0f,
        0.0f, 0.0f);
  }
  void add_torque(std::size_t step, std::uint64_t time) {
    add("vehicle_torque_setpoint", time, time_of(step) - 300, static_cast<float>(step), 0.0f, 0.0f);
  }

  std::shared_ptr<LoggedTicks> open() {
    EXPECT_TRUE(writer_.commit());
    auto log = read_flight_log(path_, {}, false);
    if (!log) throw std::runtime_error(log.error().message);
    return log->units[1].ticks;
  }

  // All steps, read in parts.
  std::vector<Sample> steps() {
    std::vector<Sample> all;
    EXPECT_TRUE(for_each_part(*open(), 700, [&](const Trace& part, std::size_t, bool) {
      all.insert(all.end(), part.samples.begin(), part.samples.end());
      return true;
    }));
    return all;
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "px4.ulg";
  ulog::Writer writer_ = ulog::Writer::open(path_, 0).value();
  std::map<std::string, std::uint16_t> ids_;
};

TEST_F(LongLog, SamplesThatAreLateInTheFileAreThereInTime) {
  constexpr std::size_t steps_in_log = 3000, late = 50;
  for (std::size_t step = 0; step < steps_in_log + late; ++step) {
    if (step < steps_in_log) add_step(step);
    if (step >= late) add_setpoint(step - late);
    if (step >= late) add_torque(step - late, time_of(step - late) + 100);
  }
  const std::vector<Sample> found = steps();
  ASSERT_EQ(found.size(), steps_in_log);
  for (std::size_t step = 0; step < steps_in_log; ++step) {
    EXPECT_EQ(found[step].rate_in.vehicle_rates_setpoint.roll, static_cast<float>(step));
    EXPECT_EQ(found[step].rate_out.vehicle_torque_setpoint.xyz[0], static_cast<float>(step));
    EXPECT_EQ(found[step].rate_out.vehicle_torque_setpoint.published, 1);
  }
}

// PX4's logger writes the last sample of each topic when it starts.
TEST_F(LongLog, ASampleFromBeforeTheFirstStepMayFollowIt) {
  for (std::size_t step = 0; step < 2000; ++step) {
    add_step(step);
    if (step == 1500) add("vehicle_control_mode", 5000, true);
    if (step == 0) add_setpoint(0);
    add_torque(step, time_of(step) + 100);
  }
  const std::vector<Sample> found = steps();
  EXPECT_EQ(found[0].rate_in.vehicle_control_mode.flag_control_rates_enabled, 1);
}

TEST_F(LongLog, AnOutputAfterAThousandStepsIsNotPaired) {
  for (std::size_t step = 0; step < 3000; ++step) {
    add_step(step);
    if (step == 0) add_setpoint(0);
    if (step == 900) add_torque(1, time_of(step) + 100);
    if (step == 1500) add_torque(2, time_of(step) + 100);
  }
  const std::vector<Sample> found = steps();
  EXPECT_EQ(found[1].rate_out.vehicle_torque_setpoint.published, 1);
  EXPECT_EQ(found[2].rate_out.vehicle_torque_setpoint.published, 0);
}

TEST_F(LongLog, AFileThatBecomesShorterIsAnError) {
  for (std::size_t step = 0; step < 3000; ++step) {
    add_step(step);
    if (step == 0) add_setpoint(0);
    add_torque(step, time_of(step) + 100);
  }
  const auto ticks = open();
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
  ASSERT_TRUE(ticks->rewind());
  Trace whole;
  const auto read = ticks->next_part(whole_trace, whole);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("changed while it was read"));
}

}  // namespace
}  // namespace attest
