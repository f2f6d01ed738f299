#include "harness/verify/verdict.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/verify/run_result.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::json;
using testing::HasSubstr;

VectorResult with(Verdict verdict) {
  VectorResult result;
  result.profile = "px4-v1.5.5";
  result.group = "attitude";
  result.name = "roll_30";
  result.rate = Rate::hz(1000, 3);
  result.verdict = verdict;
  return result;
}

TEST(Verdict, NamesAreDistinctAndParsed) {
  std::set<std::string_view> names;
  for (int i = 0; i < verdict_count; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    names.insert(name_of(verdict));
    EXPECT_EQ(parse_verdict(name_of(verdict)), verdict);
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(verdict_count));
  EXPECT_EQ(name_of(Verdict::non_finite), "non-finite");
  EXPECT_EQ(name_of(Verdict::xpass), "xpass");
}

TEST(Verdict, NothingElseIsParsed) {
  for (const char* name : {"", "PASS", "passed", "non_finite", "pass "}) {
    EXPECT_FALSE(parse_verdict(name)) << name;
  }
}

TEST(Verdict, FourOfThemDoNotFailARun) {
  const std::set<Verdict> harmless{Verdict::pass, Verdict::unsupported, Verdict::skip,
                                   Verdict::xfail};
  for (int i = 0; i < verdict_count; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    EXPECT_EQ(fails_a_run(verdict), !harmless.contains(verdict)) << name_of(verdict);
    RunResult run;
    run.results = {with(Verdict::pass), with(verdict)};
    EXPECT_EQ(run.failed(), !harmless.contains(verdict)) << name_of(verdict);
  }
}

TEST(RunResult, Counts) {
  RunResult run;
  run.results = {with(Verdict::pass), with(Verdict::fail), with(Verdict::pass)};
  EXPECT_EQ(run.count(Verdict::pass), 2U);
  EXPECT_EQ(run.count(Verdict::fail), 1U);
  EXPECT_EQ(run.count(Verdict::crash), 0U);
}

// --- verdict_json ---

VectorResult through_json(const VectorResult& result) {
  const std::string line = text_of(to_json(result));
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const Result<VectorResult> back = vector_result_from_json(json::parse(line));
  EXPECT_TRUE(back) << back.error().message;
  return back ? *back : VectorResult{};
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

void expect_same(const VectorResult& a, const VectorResult& b) {
  EXPECT_EQ(a.id(), b.id());
  EXPECT_EQ(a.rate, b.rate);
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.ticks, b.ticks);
  EXPECT_EQ(a.deviating_ticks, b.deviating_ticks);
  EXPECT_EQ(bits(a.elapsed_s), bits(b.elapsed_s));
  ASSERT_EQ(a.first.has_value(), b.first.has_value());
  if (a.first) {
    EXPECT_EQ(a.first->tick, b.first->tick);
    EXPECT_EQ(a.first->timestamp_us, b.first->timestamp_us);
    EXPECT_EQ(a.first->channel, b.first->channel);
    EXPECT_EQ(bits(a.first->got), bits(b.first->got));
    EXPECT_EQ(bits(a.first->want), bits(b.first->want));
    EXPECT_EQ(a.first->ulp, b.first->ulp);
    EXPECT_EQ(bits(a.first->tolerance), bits(b.first->tolerance));
  }
  ASSERT_EQ(a.tightest.has_value(), b.tightest.has_value());
  if (a.tightest) {
    EXPECT_EQ(bits(a.tightest->ratio), bits(b.tightest->ratio));
    EXPECT_EQ(a.tightest->tick, b.tightest->tick);
    EXPECT_EQ(a.tightest->channel, b.tightest->channel);
  }
}

TEST(VerdictJson, RoundTripsEveryVerdict) {
  for (int i = 0; i < verdict_count; ++i) {
    VectorResult result = with(static_cast<Verdict>(i));
    result.reason = "line\none \"two\" \x01 \xc2\xb0";
    result.ticks = 5000;
    result.deviating_ticks = 17;
    result.elapsed_s = 0.1 + 0.2;
    expect_same(result, through_json(result));
  }
}

TEST(VerdictJson, RoundTripsEveryKindOfNumber) {
  const double inf = std::numeric_limits<double>::infinity();
  const auto negative_nan = static_cast<double>(std::bit_cast<float>(0xffc00123U));
  for (const double value :
       {0.0, -0.0, 0.10000000149011612, -1.5, 1e-45, 3.4028234663852886e38, 1e300, 5e-324, inf,
        -inf, static_cast<double>(std::bit_cast<float>(0x7fc00000U)), negative_nan}) {
    VectorResult result = with(Verdict::fail);
    Deviation first;
    first.tick = std::numeric_limits<std::size_t>::max();
    first.timestamp_us = std::numeric_limits<std::uint64_t>::max();
    first.channel = *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.yaw");
    first.got = value;
    first.want = -value;
    first.ulp = std::numeric_limits<std::int64_t>::min();
    first.tolerance = 2e-4;
    result.first = first;
    result.tightest = Headroom{std::isnan(value) ? inf : value, 3, 5};
    result.elapsed_s = std::isnan(value) ? 0 : value;
    expect_same(result, through_json(result));
  }
}

TEST(VerdictJson, OnlyASkipIsOfTheExactLevelOnly) {
  VectorResult result = with(Verdict::skip);
  EXPECT_FALSE(through_json(result).exact_only);
  result.exact_only = true;
  EXPECT_TRUE(through_json(result).exact_only);
  json wrong = to_json(result);
  wrong["verdict"] = "pass";
  ASSERT_FALSE(vector_result_from_json(wrong));
  EXPECT_THAT(vector_result_from_json(wrong).error().message, HasSubstr("`exact_only`"));
}

TEST(VerdictJson, RoundTripsAFlight) {
  const double inf = std::numeric_limits<double>::infinity();
  VectorResult result = with(Verdict::fail);
  result.plant_configuration = PlantConfiguration{"hexa", PlantKind::ode};
  for (int i = 0; i <= static_cast<int>(Measure::sink_m); ++i) {
    result.metrics.push_back({"m", static_cast<Measure>(i), inf, 0.1, 0.05, -inf, 2});
  }
  const VectorResult back = through_json(result);
  expect_same(result, back);
  ASSERT_EQ(back.metrics.size(), result.metrics.size());
  for (std::size_t i = 0; i < back.metrics.size(); ++i) {
    EXPECT_EQ(back.metrics[i].name, "m");
    EXPECT_EQ(back.metrics[i].measure, result.metrics[i].measure);
    EXPECT_EQ(back.metrics[i].value, inf);
    EXPECT_EQ(back.metrics[i].reference, 0.1);
    EXPECT_EQ(back.metrics[i].tolerance, 0.05);
    EXPECT_EQ(back.metrics[i].min, -inf);
    EXPECT_EQ(back.metrics[i].max, 2);
  }
  EXPECT_EQ(to_json(result)["metrics"][0]["within"], false);
}

TEST(MetricResult, IsWithinItsBoundsAndNearTheReference) {
  const double inf = std::numeric_limits<double>::infinity();
  const auto within = [&](double value, double reference) {
    return MetricResult{"m", Measure::sink_m, value, reference, 0.1, 0, 2}.within();
  };
  EXPECT_TRUE(within(1.05, 1));
  EXPECT_FALSE(within(1.2, 1));
  EXPECT_TRUE(within(0.95, 1));
  EXPECT_FALSE(within(0.8, 1));
  EXPECT_FALSE(within(2.05, 2));  // beyond the case's own bound
  EXPECT_FALSE(within(std::nan(""), 1));
  EXPECT_FALSE(within(1, std::nan("")));
  EXPECT_TRUE((MetricResult{"m", Measure::sink_m, inf, inf, 0.1, 0, inf}.within()));
  EXPECT_FALSE((MetricResult{"m", Measure::sink_m, 1, inf, inf, 0, inf}.within()));  // of a ratio
}

TEST(VerdictJson, RoundTripsEveryChannel) {
  for (std::size_t channel = 0; channel < channels().size(); ++channel) {
    VectorResult result = with(Verdict::fail);
    result.first = Deviation{};
    result.first->channel = channel;
    result.first->want = 1;
    expect_same(result, through_json(result));
  }
}

TEST(VerdictJson, IsWhatTheHeaderSays) {
  VectorResult result = with(Verdict::fail);
  result.first = Deviation{};
  result.first->tick = 17;
  result.first->channel = *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.roll");
  result.first->got = -1;
  result.first->want = std::numeric_limits<double>::quiet_NaN();
  const json out = to_json(result);
  EXPECT_EQ(out["id"], "px4-v1.5.5/attitude/roll_30@1000_3hz");
  EXPECT_EQ(out["rate"], "1000/3");
  EXPECT_EQ(out["first"]["channel"], "out/vehicle_rates_setpoint.roll");
  EXPECT_EQ(out["first"]["stage"], "attitude law");
  EXPECT_EQ(out["first"]["got"], -1.0);
  EXPECT_EQ(out["first"]["got_bits"], "0xbf800000");
  EXPECT_EQ(out["first"]["want"], "nan");
  EXPECT_EQ(out["first"]["want_bits"], "0x7fc00000");
  EXPECT_FALSE(out["first"].contains("stages"));
  EXPECT_FALSE(out.contains("tightest"));
  result.first->channel =
      *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.published");
  EXPECT_FALSE(to_json(result)["first"].contains("got_bits"));
}

TEST(VerdictJson, HasTheStagesOfTheFirstDeviation) {
  VectorResult result = with(Verdict::fail);
  result.first = Deviation{};
  result.first->channel = *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.roll");
  result.first->stages = only(Stage::sticks);
  EXPECT_EQ(to_json(result)["first"]["stage"], "sticks");
  result.first->stages |= only(Stage::attitude_law);
  json out = to_json(result);
  EXPECT_EQ(out["first"]["stage"], "attitude law");
  EXPECT_EQ(out["first"]["stages"], json({"sticks", "attitude law"}));
  EXPECT_EQ(through_json(result).first->stages, result.first->stages);
  out["first"]["stages"][0] = "torsion";
  EXPECT_THAT(vector_result_from_json(out).error().message, HasSubstr("no stage `torsion`"));
}

TEST(VerdictJson, WordsThatAreNotUtf8AreRepaired) {
  VectorResult result = with(Verdict::crash);
  result.reason = "last words: \xff";
  EXPECT_EQ(through_json(result).reason, "last words: \xef\xbf\xbd");
}

// Each is a line that a broken process could send.
TEST(VerdictJson, NothingIsTakenOnTrust) {
  VectorResult result = with(Verdict::fail);
  result.first = Deviation{};
  result.first->channel = *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.roll");
  result.tightest = Headroom{};
  const json right = to_json(result);
  const auto complaint = [](const json& wrong) {
    const auto read = vector_result_from_json(wrong);
    return read ? std::string("accepted") : read.error().message;
  };
  const auto with_member = [&right](const char* pointer, const json& value) {
    json wrong = right;
    wrong[json::json_pointer(pointer)] = value;
    return wrong;
  };
  ASSERT_EQ(complaint(right), "accepted");
  EXPECT_THAT(complaint(json::parse("{\"id\": ", nullptr, false)), HasSubstr("not an object"));
  EXPECT_THAT(complaint(json::array()), HasSubstr("not an object"));
  EXPECT_THAT(complaint(nullptr), HasSubstr("not an object"));
  EXPECT_THAT(complaint(json::object()), HasSubstr("`profile` is missing"));
  EXPECT_THAT(complaint(with_member("/group", 7)), HasSubstr("`group` is not a string"));
  EXPECT_THAT(complaint(with_member("/ticks", -1)), HasSubstr("`ticks` is not a count"));
  EXPECT_THAT(complaint(with_member("/ticks", 1.5)), HasSubstr("`ticks` is not a count"));
  EXPECT_THAT(complaint(with_member("/elapsed_s", "NaN")), HasSubstr("`elapsed_s` is not a num"));
  EXPECT_THAT(complaint(with_member("/elapsed_s", nullptr)), HasSubstr("`elapsed_s` is not a n"));
  EXPECT_THAT(complaint(with_member("/verdict", "passed")), HasSubstr("no verdict `passed`"));
  EXPECT_NE(complaint(with_member("/rate", "0")), "accepted");
  EXPECT_THAT(complaint(with_member("/vehicle", "iris")), HasSubstr("`plant` is missing"));
  EXPECT_THAT(complaint(with_member("/metrics", json::array({3}))), HasSubstr("not an object"));
  EXPECT_THAT(complaint(with_member("/first", "x")), HasSubstr("not an object"));
  EXPECT_THAT(complaint(with_member("/first/channel", "out/x")), HasSubstr("signal `out/x`"));
  EXPECT_THAT(complaint(with_member("/first/ulp", 0.5)), HasSubstr("`ulp` is not an integer"));
  EXPECT_THAT(complaint(with_member("/first/got_bits", "0xzzzzzzzz")), HasSubstr("8 hex digits"));
  EXPECT_THAT(complaint(with_member("/first/got_bits", "0x1")), HasSubstr("8 hex digits"));
  EXPECT_THAT(complaint(with_member("/tightest/tick", "3")), HasSubstr("`tick` is not a count"));
}

}  // namespace
}  // namespace attest
