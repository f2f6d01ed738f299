#include "harness/ulog/trace_log.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "harness/ulog/reader.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A flown trace of three ticks, 4 ms apart.
Trace flown() {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  for (std::size_t tick = 0; tick < 3; ++tick) {
    Sample sample{};
    sample.in.timestamp = 4000 * (tick + 1);
    sample.in.control_state.q[2] = 0.25f + static_cast<float>(tick);
    sample.in.vehicle_rates_setpoint.roll = -1;
    sample.in.vehicle_status.is_vtol = 7;
    sample.in.battery_status.scale = 0.875f;
    sample.out.vehicle_rates_setpoint.roll = 0.5f * static_cast<float>(tick);
    trace.samples.push_back(sample);
    PlantSample plant{};
    plant.velocity_m_s[1] = 3;
    plant.voltage_V = 12.5f;
    trace.plant.push_back(plant);
  }
  trace.samples[1].in.updated =
      ATTEST_UPDATED_VEHICLE_STATUS | ATTEST_UPDATED_VEHICLE_RATES_SETPOINT;
  trace.samples[2].in.updated = ATTEST_UPDATED_PARAMETER_UPDATE;
  trace.samples[0].out.vehicle_rates_setpoint.published = 1;
  trace.samples[2].out.vehicle_rates_setpoint.published = 1;
  trace.parameters = {{0, "MC_ROLL_P", 6.5f}, {2, "MC_ROLL_P", 7.0f}};
  return trace;
}

class TraceLog : public testing::Test {
 protected:
  std::filesystem::path path(const char* name) const { return directory_.path() / name; }
  Result<void> write(const char* name, const Trace& trace) const {
    return write_log(*AtomicFile::open(path(name)), trace);
  }

  // "timestamp:value" of the data of a field.
  std::vector<std::string> logged(const char* topic, std::uint8_t multi_id, const char* field) {
    auto reader = ulog::Reader::open(path("f.ulg"));
    if (!reader) return {reader.error().message};
    const auto time = reader->find(topic, multi_id, "timestamp");
    const auto value = reader->find(topic, multi_id, field);
    if (!time || !value) return {value ? "" : value.error().message};
    std::vector<std::string> found;
    ulog::Message message;
    for (auto more = reader->next(message); more && *more; more = reader->next(message)) {
      const auto* data = std::get_if<ulog::Data>(&message);
      if (data == nullptr || !value->is_in(*data)) continue;
      found.push_back(std::to_string(time->of<std::uint64_t>(*data)) + ":" +
                      std::to_string(value->of<float>(*data)));
    }
    EXPECT_EQ(reader->damage().total(), 0u);
    return found;
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(TraceLog, HasEachTopicWhenItIsNew) {
  ASSERT_TRUE(write("f.ulg", flown()));
  EXPECT_THAT(logged("control_state", 0, "q[2]"),
              ElementsAre("4000:0.250000", "8000:1.250000", "12000:2.250000"));
  EXPECT_THAT(logged("vehicle_status", 0, "is_vtol"), ElementsAre("8000:7.000000"));
  EXPECT_THAT(logged("vehicle_rates_setpoint", 0, "roll"),
              ElementsAre("4000:0.000000", "12000:1.000000"));
  EXPECT_THAT(logged("vehicle_rates_setpoint", 1, "roll"), ElementsAre("8000:-1.000000"));
  EXPECT_THAT(logged("mc_att_ctrl_status", 0, "roll_rate_integ"), ElementsAre());
}

TEST_F(TraceLog, HasTheVehicleAtEachTick) {
  ASSERT_TRUE(write("f.ulg", flown()));
  EXPECT_THAT(logged("vehicle_local_position", 0, "vy"),
              ElementsAre("4000:3.000000", "8000:3.000000", "12000:3.000000"));
  EXPECT_THAT(logged("rotor_speed", 0, "value[7]"), testing::SizeIs(3));
  // A field of the unit's inputs, and one of the plant.
  EXPECT_THAT(logged("battery_status", 0, "scale"), testing::Contains("8000:0.875000"));
  EXPECT_THAT(logged("battery_status", 0, "voltage_v"), testing::Contains("8000:12.500000"));
}

TEST_F(TraceLog, HasParametersWhenTheyChange) {
  ASSERT_TRUE(write("f.ulg", flown()));
  auto reader = ulog::Reader::open(path("f.ulg"));
  ASSERT_TRUE(reader);
  std::vector<float> values;
  std::size_t data_before_change = 0;
  ulog::Message message;
  for (auto more = reader->next(message); more && *more; more = reader->next(message)) {
    if (std::holds_alternative<ulog::Data>(message) && values.size() < 2) ++data_before_change;
    const auto* value = std::get_if<ulog::KeyValue>(&message);
    if (value == nullptr || value->kind != 'P') continue;
    EXPECT_EQ(value->name, "MC_ROLL_P");
    values.push_back(ulog::load<float>(value->bytes.data()));
  }
  EXPECT_THAT(values, ElementsAre(6.5f, 7.0f));
  EXPECT_GT(data_before_change, 10u);
}

TEST_F(TraceLog, OtherModulesAreAnError) {
  Trace mixer = flown();
  mixer.present = channels_of(Module::mixer);
  EXPECT_THAT(write("m.ulg", mixer).error().message,
              HasSubstr("a ULog is for traces of the controller or of a unit of it"));
  EXPECT_FALSE(std::filesystem::exists(path("m.ulg")));
}

}  // namespace
}  // namespace attest
