// Writes the log of a flight of the controller in a test, and reads it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/writer.hpp"
#include "tests/harness/ulog/log_file.hpp"

namespace attest {

inline constexpr const char* state =
    "control_state:uint64_t timestamp;float[4] q;float roll_rate;"
    "float pitch_rate;float yaw_rate;";
inline constexpr const char* setpoint =
    "vehicle_attitude_setpoint:uint64_t timestamp;float[4] q_d;float thrust;"
    "float yaw_sp_move_rate;";
inline constexpr const char* rates =
    "vehicle_rates_setpoint:uint64_t timestamp;float roll;float pitch;float yaw;float thrust;";
inline constexpr const char* controls =
    "actuator_controls_0:uint64_t timestamp;uint64_t timestamp_sample;float[8] control;";

// A log with any of these topics.
class FlightLogFile : public ulog::LogFile {
 protected:
  std::filesystem::path path() const { return directory_.path() / "flight.ulg"; }

  void define(const std::vector<std::string>& topics) {
    for (const std::string& topic : topics) ASSERT_TRUE(writer_.define(topic));
    for (const std::string& topic : topics) {
      const std::string name = topic.substr(0, topic.find(':'));
      ids_[name] = *writer_.subscribe(name);
    }
  }
  template <typename... Values>
  void add(const char* topic, std::uint64_t time, Values... values) {
    ASSERT_TRUE(writer_.data(ids_.at(topic), ulog::raw(time, values...)));
  }
  void add_state(std::uint64_t time, float roll_rate = 0) {
    add("control_state", time, 1.0f, 0.0f, 0.0f, 0.0f, roll_rate, 0.0f, 0.0f);
  }
  void add_setpoint(std::uint64_t time, float thrust = 0.5f) {
    add("vehicle_attitude_setpoint", time, 1.0f, 0.0f, 0.0f, 0.0f, thrust, 0.0f);
  }
  void add_rates(std::uint64_t time, float roll) {
    add("vehicle_rates_setpoint", time, roll, 0.0f, 0.0f, 0.5f);
  }
  void add_controls(std::uint64_t time, std::uint64_t sampled, float roll) {
    add("actuator_controls_0", time, sampled, roll, 0.0f, 0.0f, 0.5f, 0.0f, 0.0f, 0.0f, 0.0f);
  }
  // A log with one step, which a test extends.
  void start(const char* other_topic = "other:uint64_t timestamp;") {
    define({state, setpoint, rates, controls, other_topic});
    add_setpoint(1000);
    add_state(1000);
    add_rates(1050, 0.25f);
    add_controls(1080, 1000, 0.5f);
  }

  FlightLog read(const std::vector<std::string>& assumed = {}) {
    auto log = written(assumed);
    EXPECT_TRUE(log) << log.error().message;
    return *std::move(log);
  }
  std::string error(const std::vector<std::string>& assumed = {}) {
    const auto log = written(assumed);
    return log ? log->too_little : log.error().message;
  }

  ulog::Writer writer_ = ulog::Writer::open(path(), 0).value();

 private:
  Result<FlightLog> written(const std::vector<std::string>& assumed) {
    if (!std::exchange(is_written_, true)) {
      EXPECT_TRUE(writer_.commit());
    }
    return read_flight_log(path(), assumed);
  }

  bool is_written_ = false;
  std::map<std::string, std::uint16_t> ids_;
};

}  // namespace attest
