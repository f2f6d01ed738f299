#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/baseline.hpp"
#include "harness/golden/reference.hpp"
#include "harness/report/hunt_document.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// A rate of 0.5 rad/s; the port's torque is wrong at the last of the ticks.
HuntFinding finding_of(std::size_t ticks, Level level = Level::numeric,
                       Module module = Module::rate_law) {
  HuntFinding finding;
  finding.name = "wrong_torque";
  Trace inputs;
  inputs.present = channels_of(module);
  for (std::size_t i = 0; i < ticks; ++i) {
    Sample sample = baseline_sample(module);
    sample.in.timestamp = 5'000'000 + 4000 * i;
    set_value(channels()[*find_channel(module, "in/vehicle_angular_velocity.xyz[0]")], sample, 0.5);
    inputs.samples.push_back(sample);
  }
  const ModuleUnderTest subject{.profile = "px4-v1.16.0", .module = module};
  finding.trace = reference_outputs(subject, inputs).value();
  finding.got = finding.trace;
  const auto torque = *find_channel(module, "out/vehicle_torque_setpoint.xyz[1]");
  set_value(channels()[torque], finding.got.samples.back(), 0.25);
  finding.failure = passed("hunt", "rate_law", Rate::hz(250));
  finding.failure.verdict = Verdict::fail;
  finding.failure.compared = level;
  Deviation first;
  first.tick = ticks - 1;
  first.timestamp_us = inputs.samples.back().in.timestamp;
  first.channel = torque;
  first.got = 0.25;
  finding.failure.first = first;
  return finding;
}

Document document_of(HuntFinding finding) {
  HuntReport report;
  report.found.findings.push_back(std::move(finding));
  return hunt_document(report, HuntCases::left_out);
}

std::vector<std::string> texts_of(const std::vector<Cell>& row) {
  std::vector<std::string> texts;
  for (const Cell& cell : row) texts.push_back(cell.text);
  return texts;
}

TEST(HuntPage, AFindingOfFewTicksHasATableOfItsValues) {
  const Document document = document_of(finding_of(2));
  ASSERT_THAT(document.tables, SizeIs(2));
  const DocumentTable& values = document.tables[1];
  EXPECT_EQ(document.tables[0].rows[0][0].link, values.id);
  EXPECT_THAT(values.header, ElementsAre("signal", "tick 0", "tick 1"));
  ASSERT_THAT(values.rows, SizeIs(4));
  EXPECT_THAT(texts_of(values.rows[0]),
              ElementsAre("in/vehicle_angular_velocity.xyz[0] [rad/s]", "0.5", "0.5"));
  EXPECT_THAT(texts_of(values.rows[1]),
              ElementsAre("out/vehicle_torque_setpoint.xyz[1], got", "0", "0.25"));
  EXPECT_EQ(values.rows[1][1].verdict, std::nullopt);
  EXPECT_EQ(values.rows[1][2].verdict, Verdict::fail);
  EXPECT_THAT(texts_of(values.rows[2]),
              ElementsAre("out/vehicle_torque_setpoint.xyz[1], want", "0", "0"));
  EXPECT_THAT(texts_of(values.rows[3]),
              ElementsAre("out/vehicle_torque_setpoint.xyz[1], allowed", "0.0001", "0.0001"));
  EXPECT_THAT(document.groups, IsEmpty());
}

TEST(HuntPage, AFindingOfMoreTicksHasAPlotOfEachDeviatingOutput) {
  const Document document = document_of(finding_of(5));
  EXPECT_THAT(document.tables[1].header, ElementsAre("signal", "tick 2", "tick 3", "tick 4"));
  ASSERT_THAT(document.groups, SizeIs(1));
  EXPECT_EQ(document.groups[0].title, "wrong_torque");
  ASSERT_THAT(document.groups[0].plots, SizeIs(1));
  const Plot& plot = document.groups[0].plots[0];
  EXPECT_EQ(plot.title, "out/vehicle_torque_setpoint.xyz[1]");
  EXPECT_THAT(plot.series[0].y, ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(plot.series[1].y, ElementsAre(0, 0, 0, 0, 0.25F));
  ASSERT_TRUE(plot.band);
  EXPECT_THAT(plot.band->low, SizeIs(5));
  EXPECT_FLOAT_EQ(plot.band->high[4], 1e-4F);
  ASSERT_THAT(plot.marks, SizeIs(1));
  EXPECT_DOUBLE_EQ(plot.marks[0].x, 0.016);
}

TEST(HuntPage, OfALongTraceTheTicksBeforeTheDeviationAreShown) {
  HuntFinding finding = finding_of(9);
  finding.got.samples.erase(finding.got.samples.begin(), finding.got.samples.end() - 4);
  const Document document = document_of(finding);
  EXPECT_THAT(document.tables[1].header, ElementsAre("signal", "tick 6", "tick 7", "tick 8"));
  EXPECT_THAT(document.groups.at(0).plots.at(0).series[0].x, SizeIs(4));
  EXPECT_DOUBLE_EQ(document.groups[0].plots[0].marks.at(0).x, 0.012);
}

TEST(HuntPage, AtTheLevelExactNothingIsAllowed) {
  const Document document = document_of(finding_of(5, Level::exact));
  EXPECT_THAT(document.tables[1].rows, SizeIs(3));
  EXPECT_FALSE(document.groups.at(0).plots.at(0).band);
}

TEST(HuntPage, AParameterHasItsValueAtEachTick) {
  HuntFinding finding = finding_of(2);
  finding.trace.parameters = {{0, "MC_ROLLRATE_P", 0.5F}, {1, "MC_ROLLRATE_P", 0.75F}};
  const DocumentTable values = document_of(finding).tables.at(1);
  EXPECT_THAT(texts_of(values.rows.at(1)),
              ElementsAre("in/parameter.MC_ROLLRATE_P", "0.5", "0.75"));
}

// At the first tick of a case all topics are new.
TEST(HuntPage, OfAUnitTheTimesAndLaterNewsHaveRows) {
  HuntFinding finding = finding_of(2, Level::numeric, Module::rate_unit);
  for (Trace* trace : {&finding.trace, &finding.got}) {
    trace->samples[0].in.updated = ~0U;
    const auto setpoint = updated_channel(Module::rate_unit, "vehicle_rates_setpoint");
    set_value(channels()[setpoint], trace->samples[1], 1);
  }
  const DocumentTable values = document_of(finding).tables.at(1);
  EXPECT_THAT(texts_of(values.rows.at(0)), ElementsAre("timestamp [us]", "5000000", "5004000"));
  std::vector<std::string> news;
  for (const std::vector<Cell>& row : values.rows) {
    if (row[0].text.starts_with("in/updated.")) news.push_back(row[0].text);
  }
  EXPECT_THAT(news, ElementsAre("in/updated.vehicle_rates_setpoint"));
}

TEST(HuntPage, TheValuesAreNotInTheText) {
  HuntFinding finding = finding_of(5);
  const std::string text = render_text(document_of(finding), TerminalStyle());
  finding.got.samples.clear();
  EXPECT_EQ(text, render_text(document_of(finding), TerminalStyle()));
}

TEST(HuntPage, AFindingWithoutADeviationHasNoValues) {
  HuntFinding finding = finding_of(5);
  finding.failure.verdict = Verdict::crash;
  finding.failure.first.reset();
  const Document document = document_of(finding);
  EXPECT_THAT(document.tables, SizeIs(1));
  EXPECT_THAT(document.groups, IsEmpty());
  EXPECT_THAT(html_page(document), HasSubstr("wrong_torque"));
}

}  // namespace
}  // namespace attest
