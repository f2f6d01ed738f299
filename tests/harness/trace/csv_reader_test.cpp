#include <bit>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "harness/trace/csv.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/trace/sheet.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

class CsvReader : public testing::Test {
 protected:
  Trace read(std::string_view text, TraceNeed need = TraceNeed::inputs_and_outputs) {
    auto trace = read_csv(directory_.write("a.csv", text), need);
    EXPECT_TRUE(trace) << trace.error().to_string();
    return trace ? *std::move(trace) : Trace{};
  }

  TemporaryDirectory directory_;
};

TEST_F(CsvReader, ReadsARecordedTrace) {
  const Trace trace = read(Sheet::recorded().text());
  EXPECT_EQ(trace.source, (directory_.path() / "a.csv").string());
  ASSERT_EQ(trace.samples.size(), 3u);
  const Sample& first = trace.samples[0];
  EXPECT_EQ(first.in.timestamp, 5004000u);
  EXPECT_EQ(first.in.updated, 0x1ffu);
  EXPECT_EQ(first.in.control_state.q[1], -0.00081530656f);
  EXPECT_EQ(first.in.vehicle_rates_setpoint.thrust, 0.4f);
  EXPECT_EQ(first.in.vehicle_control_mode.flag_control_rates_enabled, 1);
  EXPECT_EQ(first.in.battery_status.scale, 1.0f);
  EXPECT_EQ(first.out.vehicle_rates_setpoint.published, 1);
  EXPECT_EQ(first.out.actuator_controls_0.control[7], 0.0f);
  EXPECT_EQ(first.out.mc_att_ctrl_status.yaw_rate_integ, 0.000155419999f);
  const Sample& last = trace.samples[2];
  EXPECT_EQ(last.in.timestamp, 5012000u);
  EXPECT_EQ(last.in.updated, 0u);
  EXPECT_EQ(last.out.actuator_controls_0.control[1], -0.188992217f);
  EXPECT_TRUE(trace.parameters.empty());
}

TEST_F(CsvReader, ChannelsWithoutAColumnAreNotPresent) {
  const Trace trace = read(Sheet::recorded().text());
  EXPECT_EQ(trace.present.count(), channels_of(Module::mc_att_control).count() - 3);
  EXPECT_FALSE(
      trace.present[*find_channel(Module::mc_att_control, "out/actuator_controls_0.control[4]")]);
  EXPECT_TRUE(
      trace.present[*find_channel(Module::mc_att_control, "out/actuator_controls_0.control[7]")]);
}

TEST_F(CsvReader, TakesWhatIsNeededAndNoMore) {
  Sheet inputs = Sheet::recorded();
  for (const Channel& channel : channels()) {
    if (channel.module != Module::mc_att_control) continue;
    if (channel.is_output() && channel.name.find("control[") == channel.name.npos) {
      inputs.remove(channel.name);
    }
  }
  for (const char* i : {"0", "1", "2", "3", "7"}) {
    inputs.remove("out/actuator_controls_0.control[" + std::string(i) + "]");
  }
  EXPECT_EQ(read(inputs.text(), TraceNeed::inputs).samples.size(), 3u);
  EXPECT_EQ(read("out/vehicle_rates_setpoint.yaw,timestamp\n0.5,1\n", TraceNeed::outputs)
                .samples[0]
                .out.vehicle_rates_setpoint.yaw,
            0.5f);
}

TEST_F(CsvReader, AcceptsCrLfAByteOrderMarkAndAnyEnd) {
  const std::string text = Sheet::recorded().text();
  const Trace plain = read(text);
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_TRUE(same_samples(read(crlf), plain));
  EXPECT_TRUE(same_samples(read("\xEF\xBB\xBF" + text), plain));
  EXPECT_TRUE(same_samples(read("\xEF\xBB\xBF" + crlf + "\r\n"), plain));
  EXPECT_TRUE(same_samples(read(text + "\n\n"), plain));
  EXPECT_TRUE(same_samples(read(text.substr(0, text.size() - 1)), plain));
  EXPECT_TRUE(same_samples(read(crlf.substr(0, crlf.size() - 2)), plain));
  EXPECT_TRUE(same_samples(read(crlf.substr(0, crlf.size() - 1)), plain));
}

TEST_F(CsvReader, AcceptsAnyOrderOfColumns) {
  Sheet sheet = Sheet::recorded();
  sheet.remove("timestamp");
  sheet.remove("in/updated.battery_status");
  sheet.add("in/updated.battery_status", {"1", "0", "0"});
  sheet.add("timestamp", {"5004000", "5008000", "5012000"});
  EXPECT_TRUE(same_samples(read(sheet.text()), read(Sheet::recorded().text())));
}

TEST_F(CsvReader, AcceptsEveryDecimalNumber) {
  Sheet sheet = Sheet::recorded();
  const auto value = [&](const std::string& cell) {
    sheet.cell(2, "in/battery_status.scale") = cell;
    return read(sheet.text()).samples[1].in.battery_status.scale;
  };
  EXPECT_EQ(value("7"), 7.0f);
  EXPECT_EQ(value("+1.5"), 1.5f);
  EXPECT_EQ(value("-1.5e+3"), -1500.0f);
  EXPECT_EQ(value(".5"), 0.5f);
  EXPECT_EQ(value("5."), 5.0f);
  EXPECT_EQ(value("1E2"), 100.0f);
  EXPECT_EQ(value("0.1000000000000000055511151231257827021181583404541015625"), 0.1f);
  EXPECT_EQ(value("1" + std::string(38, '0')), 1e38f);
  EXPECT_EQ(value("inf"), INFINITY);
  EXPECT_EQ(value("-Infinity"), -INFINITY);
  EXPECT_EQ(value("+inf"), INFINITY);
  EXPECT_TRUE(std::signbit(value("-0")));
  EXPECT_TRUE(std::signbit(value("-0.0")));
}

TEST_F(CsvReader, ReadsSmallNumbersAsTheyAreAndTinyOnesAsZero) {
  Sheet sheet = Sheet::recorded();
  const auto bits = [&](const std::string& cell) {
    sheet.cell(1, "in/battery_status.scale") = cell;
    return std::bit_cast<std::uint32_t>(read(sheet.text()).samples[0].in.battery_status.scale);
  };
  EXPECT_EQ(bits("1e-45"), 1u);
  EXPECT_EQ(bits("-1e-45"), 0x80000001u);
  EXPECT_EQ(bits("1.1754942e-38"), 0x7fffffu);
  EXPECT_EQ(bits("1e-46"), 0u);
  EXPECT_EQ(bits("+1e-46"), 0u);
  EXPECT_EQ(bits("-1e-400"), 0x80000000u);
  EXPECT_EQ(bits("1e-99999999999999999999"), 0u);
  EXPECT_EQ(bits("0." + std::string(500, '0') + "1"), 0u);
  EXPECT_EQ(bits("0.001e-100"), 0u);
  EXPECT_EQ(bits("12345" + std::string(100, '0') + "e-200"), 0u);
  EXPECT_EQ(bits("0e99999999999999999999"), 0u);
}

TEST_F(CsvReader, HasOneNaN) {
  Sheet sheet = Sheet::recorded();
  for (const std::string cell : {"nan", "-nan", "NaN", "NAN"}) {
    sheet.cell(1, "in/battery_status.scale") = cell;
    const float value = read(sheet.text()).samples[0].in.battery_status.scale;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(value), 0x7fc00000u) << cell;
  }
}

TEST_F(CsvReader, AcceptsEveryByteAsAFlag) {
  Sheet sheet = Sheet::recorded();
  sheet.cell(1, "in/multirotor_motor_limits.yaw") = "4";
  sheet.cell(2, "in/multirotor_motor_limits.yaw") = "255";
  sheet.cell(3, "in/multirotor_motor_limits.yaw") = "016";
  const Trace trace = read(sheet.text());
  EXPECT_EQ(trace.samples[0].in.multirotor_motor_limits.yaw, 4);
  EXPECT_EQ(trace.samples[1].in.multirotor_motor_limits.yaw, 255);
  EXPECT_EQ(trace.samples[2].in.multirotor_motor_limits.yaw, 16);
}

TEST_F(CsvReader, TurnsParameterColumnsIntoChanges) {
  Sheet sheet = Sheet::recorded();
  sheet.add("in/parameter.MC_ROLL_P", {"6.5", "7", "8"});
  sheet.add("in/parameter.MC_YAW_P", {"nan", "nan", "-nan"});
  sheet.add("in/parameter.MC_PITCH_P", {"0", "1", "-0"});
  sheet.cell(1, "in/updated.parameter_update") = "0";  // tick 0 takes all nevertheless
  sheet.cell(2, "in/updated.parameter_update") = "0";
  sheet.cell(3, "in/updated.parameter_update") = "1";
  const Trace trace = read(sheet.text());
  ASSERT_EQ(trace.parameters.size(), 5u);
  EXPECT_EQ(trace.parameters[0], (ParameterChange{0, "MC_ROLL_P", 6.5f}));
  EXPECT_EQ(trace.parameters[1].name, "MC_YAW_P");
  EXPECT_TRUE(std::isnan(trace.parameters[1].value));
  EXPECT_EQ(trace.parameters[2], (ParameterChange{0, "MC_PITCH_P", 0.0f}));
  EXPECT_EQ(trace.parameters[3], (ParameterChange{2, "MC_ROLL_P", 8.0f}));
  EXPECT_EQ(trace.parameters[4].name, "MC_PITCH_P");
  EXPECT_TRUE(std::signbit(trace.parameters[4].value));
}

TEST_F(CsvReader, ReadsFilesLongerThanItsBuffer) {
  std::string text = "timestamp,out/vehicle_rates_setpoint.yaw\n";
  constexpr std::size_t rows = 100000;
  for (std::size_t i = 1; i <= rows; ++i) {
    text += std::to_string(i) + "," + std::to_string(i % 1000) + ".5\r\n";
  }
  const Trace trace = read(text, TraceNeed::outputs);
  ASSERT_EQ(trace.samples.size(), rows);
  for (std::size_t i = 1; i <= rows; ++i) {
    ASSERT_EQ(trace.samples[i - 1].in.timestamp, i);
    ASSERT_EQ(trace.samples[i - 1].out.vehicle_rates_setpoint.yaw,
              static_cast<float>(i % 1000) + 0.5f);
  }
}

}  // namespace
}  // namespace attest
