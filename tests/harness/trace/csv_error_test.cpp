#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/trace/csv.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/trace/sheet.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

class CsvErrors : public testing::Test {
 protected:
  // The error without the directory: "a.csv:2:1: ...".
  std::string error_of(std::string_view text, TraceNeed need = TraceNeed::inputs_and_outputs) {
    const auto trace = read_csv(directory_.write("a.csv", text), need);
    if (trace) return "";
    const std::string whole = trace.error().to_string();
    const std::string here = directory_.path().string() + "/";
    EXPECT_TRUE(whole.starts_with(here)) << whole;
    return whole.substr(here.size());
  }

  // The error for a cell of the recorded sheet.
  std::string error_of_cell(std::size_t row, std::string_view column, const std::string& text) {
    Sheet sheet = Sheet::recorded();
    sheet.cell(row, column) = text;
    return error_of(sheet.text());
  }

  TemporaryDirectory directory_;
};

TEST_F(CsvErrors, UnreadableFile) {
  const std::string missing = (directory_.path() / "missing.csv").string();
  EXPECT_EQ(read_csv(missing, TraceNeed::inputs).error().to_string(),
            missing + ": cannot open the file: No such file or directory");
  const std::string here = directory_.path().string();
  EXPECT_EQ(read_csv(here, TraceNeed::inputs).error().to_string(),
            here + ": not a regular file but a directory; name a file");
}

TEST_F(CsvErrors, NoHeader) {
  constexpr const char* message = "a.csv:1:1: no header; the first line must name the columns";
  EXPECT_EQ(error_of(""), message);
  EXPECT_EQ(error_of("\n\n"), message);
  EXPECT_EQ(error_of("\xEF\xBB\xBF"), message);
  EXPECT_EQ(error_of("5004000,0.9999995\n"), message);
}

TEST_F(CsvErrors, ColumnWithoutAName) {
  EXPECT_EQ(error_of("timestamp,,out/x\n"),
            "a.csv:1:11: a column without a name; name it or remove the comma");
  EXPECT_EQ(error_of("timestamp,\n"),
            "a.csv:1:11: a column without a name; name it or remove the comma");
}

TEST_F(CsvErrors, UnknownColumn) {
  EXPECT_EQ(error_of("timestamp,in/battery_status.skale\n"),
            "a.csv:1:11: unknown column `in/battery_status.skale`; did you mean "
            "`in/battery_status.scale`?");
  const std::string all = "; `attest list --channels` shows the columns of a trace";
  EXPECT_EQ(error_of("timestamp,out/motors\n"), "a.csv:1:11: unknown column `out/motors`" + all);
  EXPECT_EQ(error_of("time,motors\n"), "a.csv:1:1: unknown column `time`" + all);
  EXPECT_EQ(error_of("timestamp,in/parameter.\n"),
            "a.csv:1:11: unknown column `in/parameter.`" + all);
  // Places count characters, as editors do.
  EXPECT_EQ(error_of("in/parameter.\xC3\xA4\xC3\xB6\xC3\xBC,x\n"),
            "a.csv:1:18: unknown column `x`" + all);
}

TEST_F(CsvErrors, RepeatedColumn) {
  EXPECT_EQ(error_of("timestamp,in/parameter.A,timestamp\n"),
            "a.csv:1:26: repeated column `timestamp`; remove one");
  EXPECT_EQ(error_of("timestamp,in/parameter.A,in/parameter.A\n"),
            "a.csv:1:26: repeated column `in/parameter.A`; remove one");
}

TEST_F(CsvErrors, MissingInput) {
  Sheet sheet = Sheet::recorded();
  sheet.remove("in/battery_status.scale");
  constexpr const char* message = "a.csv:1: no column in/battery_status.scale; add the column";
  EXPECT_EQ(error_of(sheet.text(), TraceNeed::inputs), message);
  EXPECT_EQ(error_of(sheet.text(), TraceNeed::inputs_and_outputs), message);
  EXPECT_EQ(error_of(sheet.text(), TraceNeed::outputs), "");
  sheet.remove("in/control_state.q[2]");
  sheet.remove("in/updated.battery_status");
  EXPECT_THAT(error_of(sheet.text(), TraceNeed::inputs),
              HasSubstr("a.csv:1: no column in/control_state.q[2] (nor 2 others); add"));
}

TEST_F(CsvErrors, MissingTimestamp) {
  Sheet sheet = Sheet::recorded();
  sheet.remove("timestamp");
  EXPECT_EQ(error_of(sheet.text()),
            "a.csv:1: no column timestamp; add the time of each sample in microseconds");
}

TEST_F(CsvErrors, MissingOutputs) {
  Sheet sheet = Sheet::recorded();
  for (const Channel& channel : channels()) {
    const std::string_view name = channel.name;
    const bool recorded = name.find("[4]") == name.npos && name.find("[5]") == name.npos &&
                          name.find("[6]") == name.npos;
    if (channel.module == Module::mc_att_control && channel.is_output() && recorded)
      sheet.remove(name);
  }
  constexpr const char* message = "a.csv:1: no column out/...; add at least one output of the unit";
  EXPECT_EQ(error_of(sheet.text(), TraceNeed::outputs), message);
  EXPECT_EQ(error_of(sheet.text(), TraceNeed::inputs_and_outputs), message);
  EXPECT_EQ(error_of(sheet.text(), TraceNeed::inputs), "");
}

TEST_F(CsvErrors, ShortRow) {
  EXPECT_EQ(error_of("timestamp,out/vehicle_rates_setpoint.yaw\n1,2\n3\n", TraceNeed::outputs),
            "a.csv:3:2: row has 1 of 2 cells, out/vehicle_rates_setpoint.yaw is missing; complete "
            "or remove the row");
  const std::string text = Sheet::recorded().text();
  EXPECT_THAT(error_of(text.substr(0, text.size() - 48)),
              testing::MatchesRegex("a\\.csv:4:[0-9]+: row has 57 of 61 cells, out/.* is "
                                    "missing; complete or remove the row"));
}

TEST_F(CsvErrors, LongRow) {
  EXPECT_EQ(
      error_of("timestamp,out/vehicle_rates_setpoint.yaw\n1,2\n30,4,5,6\n", TraceNeed::outputs),
      "a.csv:3:6: row has 4 cells, the header has 2; remove the extra cells");
  EXPECT_EQ(error_of("timestamp,out/vehicle_rates_setpoint.yaw\n1,2,\n", TraceNeed::outputs),
            "a.csv:2:5: row has 3 cells, the header has 2; remove the extra cells");
}

TEST_F(CsvErrors, RowOfTheWrongLengthIsNotBlamedOnItsShiftedCells) {
  EXPECT_EQ(error_of("timestamp,in/actuator_armed.armed,out/vehicle_rates_setpoint.yaw\n"
                     "1,0.5\n",
                     TraceNeed::outputs),
            "a.csv:2:6: row has 2 of 3 cells, out/vehicle_rates_setpoint.yaw is missing; complete "
            "or remove the row");
}

TEST_F(CsvErrors, NotANumber) {
  const int place = Sheet::recorded().place(2, "out/vehicle_rates_setpoint.roll");
  const std::string here = "a.csv:3:" + std::to_string(place) + ": ";
  constexpr const char* rest =
      " is not a number for out/vehicle_rates_setpoint.roll; write a decimal number, nan, inf or "
      "-inf";
  for (const std::string cell : {"1.2.3", "x", " 1", "1 ", "0x10", "--1", "+-1", "1e", "1_000",
                                 "nanx", "infinit", "\"1\"", "-", "+", "."}) {
    EXPECT_EQ(error_of_cell(2, "out/vehicle_rates_setpoint.roll", cell),
              here + "`" + cell + "`" + rest);
  }
  EXPECT_EQ(error_of_cell(2, "out/vehicle_rates_setpoint.roll", ""), here + "an empty cell" + rest);
}

TEST_F(CsvErrors, NotANumberInTheFirstAndLastCellOfARow) {
  EXPECT_EQ(error_of("out/vehicle_rates_setpoint.yaw,timestamp\nx,1\n", TraceNeed::outputs),
            "a.csv:2:1: `x` is not a number for out/vehicle_rates_setpoint.yaw; write a decimal "
            "number, nan, inf or -inf");
  EXPECT_EQ(error_of("timestamp,out/vehicle_rates_setpoint.yaw\n1,\r\n", TraceNeed::outputs),
            "a.csv:2:3: an empty cell is not a number for out/vehicle_rates_setpoint.yaw; write a "
            "decimal number, nan, inf or -inf");
}

TEST_F(CsvErrors, NumberTooLargeForAFloat) {
  const int place = Sheet::recorded().place(1, "in/battery_status.scale");
  for (const std::string cell : {"3.4028236e38", "-1e39", "1e400", "1e99999999999999999999",
                                 "0.001e99", "10000000000000000000000000000000000000000"}) {
    EXPECT_EQ(error_of_cell(1, "in/battery_status.scale", cell),
              "a.csv:2:" + std::to_string(place) + ": `" + cell +
                  "` is too large for in/battery_status.scale, a 32-bit float; write inf or -inf "
                  "for infinity");
  }
}

TEST_F(CsvErrors, NotAFlag) {
  const int place = Sheet::recorded().place(1, "in/actuator_armed.armed");
  for (const std::string cell : {"256", "-1", "1.0", "true", "nan", "+1", "99999999999"}) {
    EXPECT_EQ(error_of_cell(1, "in/actuator_armed.armed", cell),
              "a.csv:2:" + std::to_string(place) + ": `" + cell +
                  "` is not a flag for in/actuator_armed.armed; write an integer from 0 to 255");
  }
}

TEST_F(CsvErrors, NotABit) {
  const int place = Sheet::recorded().place(1, "in/updated.vehicle_status");
  for (const std::string cell : {"2", "00", "-1", "x"}) {
    EXPECT_EQ(error_of_cell(1, "in/updated.vehicle_status", cell),
              "a.csv:2:" + std::to_string(place) + ": `" + cell +
                  "` is not a bit for in/updated.vehicle_status; write 0 or 1");
  }
}

TEST_F(CsvErrors, NotATimestamp) {
  for (const std::string cell : {"-5", "1.5", "1e6", "18446744073709551616", "nan"}) {
    EXPECT_EQ(error_of_cell(1, "timestamp", cell),
              "a.csv:2:1: `" + cell +
                  "` is not an integer for timestamp; write an integer from 0 to "
                  "18446744073709551615");
  }
}

TEST_F(CsvErrors, TimestampsThatDoNotIncrease) {
  EXPECT_EQ(error_of_cell(2, "timestamp", "5004000"),
            "a.csv:3:1: timestamp 5004000 is not after the 5004000 of the row above; timestamps "
            "must increase");
  EXPECT_EQ(
      error_of("out/vehicle_rates_setpoint.yaw,timestamp\n1,7\n1,8\n10,6\n", TraceNeed::outputs),
      "a.csv:4:4: timestamp 6 is not after the 8 of the row above; timestamps must increase");
}

TEST_F(CsvErrors, NoRows) {
  const std::string text = Sheet::recorded().text();
  constexpr const char* message = "a.csv:2: no rows; a trace has a row for each tick";
  EXPECT_EQ(error_of(text.substr(0, text.find('\n'))), message);
  EXPECT_EQ(error_of(text.substr(0, text.find('\n') + 1)), message);
  EXPECT_EQ(error_of(text.substr(0, text.find('\n') + 1) + "\r\n\n"), message);
}

TEST_F(CsvErrors, EmptyLineBetweenRows) {
  EXPECT_EQ(
      error_of("timestamp,out/vehicle_rates_setpoint.yaw\n1,2\n\n\n3,4\n", TraceNeed::outputs),
      "a.csv:3:1: empty line between rows; remove it");
}

TEST_F(CsvErrors, Golden) {
  EXPECT_THAT(error_of("profiles,configurations,tick,out/vehicle_rates_setpoint.yaw\np,50hz,0,1\n"),
              HasSubstr("a.csv:1:1: is a golden, which has no inputs, and no trace"));
}

TEST_F(CsvErrors, BinaryFiles) {
  EXPECT_EQ(error_of(std::string("ULog\x01\x12\x35\0\0\n", 10)),
            "a.csv:1:1: a NUL byte in the name of a column; the file is damaged");
  EXPECT_EQ(error_of(std::string(1000000, '\0')),
            "a.csv:1: line is longer than any trace's; is this a CSV trace?");
  std::string text = Sheet::recorded().text();
  text += std::string("5016000,\0\x01\xff,", 12) + std::string(70000, 'x');
  EXPECT_EQ(error_of(text), "a.csv:5: line is longer than any trace's; is this a CSV trace?");
  EXPECT_THAT(error_of_cell(1, "in/battery_status.scale", std::string("1\0", 2)),
              HasSubstr("`1\\x00` is not a number"));
  EXPECT_THAT(error_of_cell(1, "in/battery_status.scale", std::string(100, 'x')),
              HasSubstr(std::string(60, 'x') + "...` is not a number"));
  std::string bytes;
  for (unsigned i = 0; i < 100000; ++i) bytes += static_cast<char>((i * i * 31u + i) >> 3);
  EXPECT_NE(error_of(bytes), "");
}

TEST_F(CsvErrors, TruncationAtAnyByteReadsOrFails) {
  Sheet sheet = Sheet::recorded();
  sheet.add("in/parameter.MC_ROLL_P", {"6.5", "7", "-inf"});
  const std::string text = "\xEF\xBB\xBF" + sheet.text();
  std::size_t readable = 0;
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const auto trace =
        read_csv(directory_.write("a.csv", text.substr(0, size)), TraceNeed::inputs_and_outputs);
    if (trace) {
      ++readable;
      EXPECT_FALSE(trace->samples.empty());
    } else {
      EXPECT_GE(trace.error().line, 1);
      EXPECT_NE(trace.error().message, "");
    }
  }
  // Only at the end of a row: with or without its newline, or within the digits of its last cell.
  EXPECT_EQ(readable, (3u + 1u) + (1u + 1u) + (1u + 1u));
}

}  // namespace
}  // namespace attest
