#include "harness/host/recorded_outputs.hpp"

#include <algorithm>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::size_t ticks = 5;
constexpr double period_us = 4000, start_us = 5e6;

Trace inputs() {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  for (std::size_t i = 0; i < ticks; ++i) {
    Sample sample{};
    sample.in.timestamp = static_cast<std::uint64_t>(start_us + period_us * static_cast<double>(i));
    trace.samples.push_back(sample);
  }
  return trace;
}

// Every output, published at each tick, and the time. Each value is its channel plus a tenth of the
// tick.
Table complete() {
  Table table;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    const bool is_time = channel.name == "timestamp";
    if (channel.module != Module::mc_att_control || !(channel.is_output() || is_time)) continue;
    Column column{std::string(channel.name), {}};
    for (std::size_t tick = 0; tick < ticks; ++tick) {
      const auto at = static_cast<double>(tick);
      column.values.push_back(is_time                           ? start_us + period_us * at
                              : channel.type == ChannelType::u8 ? 1
                                                                : static_cast<double>(i) + at / 10);
    }
    table.push_back(std::move(column));
  }
  return table;
}

Column& column(Table& table, const std::string& name) {
  return *std::find_if(table.begin(), table.end(),
                       [&](const Column& one) { return one.name == name; });
}

std::string error(const std::function<void(Table&)>& change, const Manifest& manifest = {}) {
  Table table = complete();
  change(table);
  Trace trace = inputs();
  const auto set = set_recorded_outputs(table, manifest, "x.out.csv", trace);
  return set ? "no error" : set.error().to_string();
}

TEST(RecordedOutputs, AreThoseOfTheTableInAnyOrder) {
  Table table = complete();
  std::reverse(table.begin(), table.end());
  column(table, "out/vehicle_rates_setpoint.yaw").name = "vehicle_rates_setpoint_yaw_";
  table.push_back({"temperature", std::vector<double>(ticks, 20.0)});
  Trace trace = inputs();
  ASSERT_TRUE(set_recorded_outputs(table, {}, "x.out.csv", trace));
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (channel.module != Module::mc_att_control || !channel.is_output()) continue;
    if (channel.type != ChannelType::f32) continue;
    EXPECT_FLOAT_EQ(float_of(channel, trace.samples[3]), static_cast<float>(i) + 0.3f);
  }
  EXPECT_THAT(ignored_columns(table, {}, Module::mc_att_control), ElementsAre("temperature"));
}

TEST(RecordedOutputs, ATopicThatIsNotPublishedKeepsItsValues) {
  Table table = complete();
  column(table, "out/vehicle_rates_setpoint.published").values = {0, 255, 0, 0, 1};
  Trace trace = inputs();
  ASSERT_TRUE(set_recorded_outputs(table, {}, "x.out.csv", trace));
  std::vector<float> got;
  for (const Sample& sample : trace.samples) got.push_back(sample.out.vehicle_rates_setpoint.roll);
  const auto first =
      static_cast<float>(*find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.roll"));
  EXPECT_THAT(got, ElementsAre(0, first + 0.1f, first + 0.1f, first + 0.1f, first + 0.4f));
}

TEST(RecordedOutputs, TimesTellWhatIsWrongWithTheRows) {
  const auto every_column = [](const std::function<void(std::vector<double>&)>& change) {
    return [change](Table& table) {
      for (Column& one : table) change(one.values);
    };
  };
  EXPECT_THAT(error(every_column([](auto& values) { values.resize(3); })),
              HasSubstr("x.out.csv: ends after tick 2 of 5: it is cut off"));
  EXPECT_THAT(error(every_column([](auto& values) { values.clear(); })), HasSubstr("has no rows"));
  EXPECT_THAT(error(every_column([](auto& values) { values.erase(values.begin() + 2); })),
              HasSubstr("has no row for tick 2 at 5008000 us"));
  EXPECT_THAT(error(every_column([](auto& values) { values.insert(values.begin(), values[0]); })),
              HasSubstr("has two rows for tick 0 at 5000000 us"));
  EXPECT_THAT(error(every_column([](auto& values) { values.push_back(9e9); })),
              HasSubstr("has more rows than the 5 ticks"));
  EXPECT_THAT(error(every_column([](auto& values) { std::swap(values[1], values[3]); })),
              HasSubstr("its rows are not in the order of time: row 2 is at 5012000 us"));
  EXPECT_THAT(error([](Table& table) {
                for (double& time : column(table, "timestamp").values) time += 1500;
              }),
              HasSubstr("row 1 is at 5001500 us, tick 0 at 5000000 us"));
}

TEST(RecordedOutputs, WithoutTimesTheNumberOfRowsMustAgree) {
  const auto without_times = [](Table& table) { table.erase(table.begin()); };
  EXPECT_EQ(error(without_times), "no error");
  EXPECT_THAT(error([&](Table& table) {
                without_times(table);
                for (Column& one : table) one.values.pop_back();
              }),
              HasSubstr("has 4 rows for 5 ticks"));
}

TEST(RecordedOutputs, TimesInAnotherUnitAreNamed) {
  const auto in = [](double microseconds) {
    return [microseconds](Table& table) {
      for (double& time : column(table, "timestamp").values) time /= microseconds;
    };
  };
  EXPECT_THAT(error(in(1e3)), HasSubstr("its times are in ms, not in us; write time = \"ms\""));
  EXPECT_THAT(error(in(1e6)), HasSubstr("its times are in s, not in us"));
  EXPECT_THAT(error(in(1e-3)), HasSubstr("its times are in ns, not in us; write them in s, ms"));
  Manifest manifest;
  manifest.time = "s";
  EXPECT_EQ(error(in(1e6), manifest), "no error");
  // A board that prints few digits.
  EXPECT_EQ(error(
                [&](Table& table) {
                  in(1e6)(table);
                  for (double& time : column(table, "timestamp").values) time += 0.0009;
                },
                manifest),
            "no error");
}

TEST(RecordedOutputs, EachOutputIsNeededOnceWithAValueOfItsKind) {
  EXPECT_THAT(error([](Table& table) { table.pop_back(); }),
              HasSubstr("no column out/mc_att_ctrl_status.yaw_rate_integ; add it"));
  EXPECT_THAT(error([](Table& table) {
                table.push_back({"out_vehicle_rates_setpoint_yaw", table.back().values});
              }),
              HasSubstr("two columns are out/vehicle_rates_setpoint.yaw"));
  for (const double wrong : {0.5, -1.0, 256.0}) {
    EXPECT_THAT(error([&](Table& table) {
                  column(table, "out/actuator_controls_0.published").values[4] = wrong;
                }),
                HasSubstr("tick 4: "));
  }
}

TEST(RecordedOutputs, AColumnThatThePortLacksIsNotRead) {
  constexpr const char* flag = "out/vehicle_rates_setpoint.published";
  Manifest manifest;
  manifest.lacks.outputs = channels_named(flag);
  Table table = complete();
  column(table, flag).values = {0, 0, 0.5, 0, 0};
  Trace trace = inputs();
  const auto set = set_recorded_outputs(table, manifest, "x.out.csv", trace);
  ASSERT_TRUE(set) << set.error().to_string();
  for (const Sample& sample : trace.samples) {
    EXPECT_EQ(sample.out.vehicle_rates_setpoint.published, 1);
    EXPECT_NE(sample.out.vehicle_rates_setpoint.roll, 0);
  }
}

}  // namespace
}  // namespace attest
