#include <cmath>

#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "harness/trace/csv.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/trace/sheet.hpp"

namespace attest {
namespace {

class CsvWriter : public testing::Test {
 protected:
  CsvWriter() {
    trace_.source = "trace";
    for (std::size_t i = 0; i < 2; ++i) {
      Sample sample{};
      sample.in.timestamp = 4000 * (i + 1);
      trace_.samples.push_back(sample);
    }
    for (const char* name : {"timestamp", "in/battery_status.scale", "in/actuator_armed.armed",
                             "in/updated.parameter_update", "out/vehicle_rates_setpoint.yaw"}) {
      trace_.present.set(*find_channel(Module::mc_att_control, name));
    }
  }

  Result<void> write(const CsvColumns& columns) { return write_csv(path(), trace_, columns); }

  std::string written(const CsvColumns& columns) {
    const auto done = write(columns);
    EXPECT_TRUE(done) << done.error().to_string();
    return read_file(path()).value();
  }

  std::string error() { return write(all_columns(trace_)).error().to_string(); }

  std::filesystem::path path() const { return directory_.path() / "a.csv"; }

  TemporaryDirectory directory_;
  Trace trace_;
};

TEST_F(CsvWriter, WritesTimestampInputsParametersOutputs) {
  trace_.samples[0].in.battery_status.scale = 0.1f;
  trace_.samples[1].in.battery_status.scale = -0.0f;
  trace_.samples[0].in.actuator_armed.armed = 255;
  trace_.samples[1].in.updated = ATTEST_UPDATED_PARAMETER_UPDATE;
  trace_.samples[1].out.vehicle_rates_setpoint.yaw = 1e-45f;
  trace_.parameters = {{0, "MC_YAW_P", 2.8f}, {0, "MC_ROLL_P", 6.5f}, {1, "MC_ROLL_P", 7.0f}};
  EXPECT_EQ(written(all_columns(trace_)),
            "timestamp,in/actuator_armed.armed,in/battery_status.scale,in/updated.parameter_update,"
            "in/parameter.MC_YAW_P,in/parameter.MC_ROLL_P,out/vehicle_rates_setpoint.yaw\n"
            "4000,255,0.1,0,2.8,6.5,0\n"
            "8000,0,-0,1,2.8,7,1e-45\n");
}

TEST_F(CsvWriter, WritesTheChosenColumnsOnly) {
  trace_.parameters = {{0, "MC_YAW_P", 2.8f}, {0, "MC_ROLL_P", 6.5f}};
  CsvColumns columns;
  columns.channels.set(*find_channel(Module::mc_att_control, "timestamp"));
  columns.channels.set(*find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.yaw"));
  columns.parameters = {"MC_ROLL_P"};
  EXPECT_EQ(written(columns),
            "timestamp,in/parameter.MC_ROLL_P,out/vehicle_rates_setpoint.yaw\n"
            "4000,6.5,0\n"
            "8000,6.5,0\n");
}

TEST_F(CsvWriter, HasOneNaNAndTwoInfinities) {
  CsvColumns columns;
  columns.channels.set(*find_channel(Module::mc_att_control, "timestamp"));
  columns.channels.set(*find_channel(Module::mc_att_control, "in/battery_status.scale"));
  const auto cell = [&](float value) {
    trace_.samples[0].in.battery_status.scale = value;
    const std::string text = written(columns);
    const std::size_t begin = text.find("4000,") + 5;
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  EXPECT_EQ(cell(NAN), "nan");
  EXPECT_EQ(cell(-NAN), "nan");
  EXPECT_EQ(cell(INFINITY), "inf");
  EXPECT_EQ(cell(-INFINITY), "-inf");
}

TEST_F(CsvWriter, KeepsEveryTimestamp) {
  trace_.samples[1].in.timestamp = ~std::uint64_t{0};
  EXPECT_NE(written(all_columns(trace_)).find("\n18446744073709551615,"), std::string::npos);
}

TEST_F(CsvWriter, WritesMoreThanFitsABlock) {
  trace_.samples.resize(1);
  CsvColumns columns;
  columns.channels.set(*find_channel(Module::mc_att_control, "timestamp"));
  std::string names = "timestamp";
  std::string values = "4000";
  for (int i = 0; i < 10; ++i) {
    const std::string name(10007, static_cast<char>('a' + i));
    trace_.parameters.push_back({0, name, 0.5f});
    columns.parameters.push_back(name);
    names += ",in/parameter." + name;
    values += ",0.5";
  }
  EXPECT_EQ(written(columns), names + "\n" + values + "\n");
}

TEST_F(CsvWriter, RefusesAParameterWithoutAValueAtTheFirstTick) {
  trace_.samples[1].in.updated = ATTEST_UPDATED_PARAMETER_UPDATE;
  trace_.parameters = {{1, "MC_ROLL_P", 7.0f}};
  EXPECT_EQ(error(),
            "trace: parameter MC_ROLL_P changes at tick 1 but has no value before; set it at tick "
            "0");
}

TEST_F(CsvWriter, RefusesAChangeThatTheUnitDoesNotReceive) {
  trace_.parameters = {{0, "MC_ROLL_P", 6.5f}, {1, "MC_ROLL_P", 7.0f}};
  EXPECT_EQ(error(),
            "trace: parameter MC_ROLL_P changes at tick 1, which does not have "
            "in/updated.parameter_update; set it there");
  trace_.parameters[1].tick = 2;
  EXPECT_EQ(error(),
            "trace: parameter MC_ROLL_P changes at tick 2, which does not have "
            "in/updated.parameter_update; set it there");
}

TEST_F(CsvWriter, RefusesAColumnForAParameterThatIsNotSet) {
  CsvColumns columns = all_columns(trace_);
  columns.parameters = {"MC_ROLL_P"};
  EXPECT_EQ(write(columns).error().to_string(),
            "trace: parameter MC_ROLL_P has no value; set it at tick 0");
}

TEST_F(CsvWriter, ReportsAFullDisk) {
  EXPECT_EQ(write_csv("/dev/full", trace_, all_columns(trace_)).error().to_string(),
            "/dev/full: cannot write the file: No space left on device");
}

}  // namespace
}  // namespace attest
