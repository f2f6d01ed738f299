#include "harness/verify/evaluate.hpp"

#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/core/file.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/port/builtin.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/trace_parts.hpp"
#include "harness/verify/verdict_json.hpp"
#include "tests/harness/golden/blessed.hpp"
#include "tests/harness/verify/small_suite.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

std::unique_ptr<PortHost> opened(const std::string& specification) {
  auto host = open_in_process_host(specification);
  if (!host) throw std::invalid_argument(host.error().to_string());
  return *std::move(host);
}

class EvaluateTest : public testing::Test {
 protected:
  // The first case at 100 Hz.
  Result<VectorResult> evaluate(const std::string& port, Level level = Level::numeric) {
    const auto golden = Goldens(suite_.golden()).open(suite_[0]);
    if (!golden) return tl::unexpected(golden.error());
    const auto host = opened(port);
    return evaluate_case(suite_[0], Rate::hz(100), *golden, *host, {level});
  }

  Verdict verdict_of(const std::string& port, Level level = Level::numeric) {
    const auto result = evaluate(port, level);
    EXPECT_TRUE(result) << result.error().to_string();
    return result ? result->verdict : Verdict::protocol;
  }

  SmallSuite suite_;
};

constexpr const char* pitching = "[control_state]\npitch_rate = 0.5\n";

TEST_F(EvaluateTest, APassHasTicksAndHeadroomToSpare) {
  suite_.add("pitch", pitching);
  const auto result = evaluate("builtin");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->id(), "px4-v1.5.5/tests/pitch@100hz");
  EXPECT_EQ(result->verdict, Verdict::pass);
  EXPECT_EQ(result->ticks, 30u);
  EXPECT_EQ(result->reason, "");
  EXPECT_EQ(verdict_of("builtin", Level::exact), Verdict::pass);
}

TEST_F(EvaluateTest, TolerancesOfTheCaseApplyToTheNumericLevel) {
  suite_.add("pitch", std::string(pitching) +
                          "[tolerance]\nwhy = \"x\"\n"
                          "actuator_controls_0 = { absolute = 9 }\n"
                          "mc_att_ctrl_status = { absolute = 9 }\n");
  EXPECT_EQ(verdict_of(test_port("sign_flip")), Verdict::pass);
  EXPECT_EQ(verdict_of(test_port("sign_flip"), Level::exact), Verdict::fail);
}

TEST_F(EvaluateTest, ACaseOnAThresholdIsForTheExactLevel) {
  suite_.add("pitch", std::string("level = \"exact\"\n") + pitching);
  const auto result = evaluate(test_port("sign_flip"));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->verdict, Verdict::skip);
  EXPECT_THAT(result->reason, HasSubstr("exact level only"));
  EXPECT_EQ(verdict_of(test_port("sign_flip"), Level::events), Verdict::skip);
  EXPECT_EQ(verdict_of(test_port("sign_flip"), Level::exact), Verdict::fail);
  EXPECT_EQ(verdict_of("builtin", Level::exact), Verdict::pass);
}

TEST_F(EvaluateTest, AMissingGoldenIsOneErrorForAllRates) {
  suite_.add_unblessed("pitch", pitching);
  const auto outcome = suite_.run(host_of("builtin"));
  EXPECT_THAT(outcome.results, testing::IsEmpty());
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_THAT(outcome.errors[0].message, HasSubstr("no golden for px4-v1.5.5/tests/pitch"));
}

// Returns the given outputs for any inputs.
class Reciting : public PortHost {
 public:
  explicit Reciting(Trace answers) : answers_(std::move(answers)) {}

  const Declarations& declarations() const override { return declarations_; }
  std::optional<PortFault> drive(const ModuleUnderTest&, Trace& trace) override {
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
      trace.samples[i].out = answers_.samples[i].out;
    }
    return std::nullopt;
  }
  Result<Flown> fly(const FlightPlan&) override { return fail("no flights"); }
  Result<LiveFlight> fly_live(const LivePlan&, const LiveWatch&) override {
    return fail("no live flights");
  }
  Result<StepTimes> time_steps(const ModuleUnderTest&, const Trace&, bool) override {
    return fail("no times");
  }
  bool supports(const std::string&) override { return true; }

  Declarations declarations_;

 private:
  Trace answers_;
};

class Talking final : public Reciting {
 public:
  Talking() : Reciting({}) {}
  std::string last_words() const override { return "no gain"; }
};

TEST(AddLastWords, OfAPortWithWrongOutputsOnly) {
  const Talking port;
  VectorResult result;
  result.verdict = Verdict::pass;
  result.first.emplace();
  add_last_words(port, result);
  EXPECT_EQ(result.reason, "");
  result.verdict = Verdict::fail;
  add_last_words(port, result);
  EXPECT_EQ(result.reason, "differs from the reference; the port last printed: no gain");
}

// Thrust comes as near as 0.005 to the integrator's gate at tick 10.
constexpr const char* over_the_gate =
    "[vehicle_attitude_setpoint]\nthrust = { signal = \"samples\", times_ticks = [0, 10], "
    "values = [0.5, 0.205] }\n";

TEST_F(EvaluateTest, ADecisionThatFewBitsDoNotResolveIsNotJudged) {
  suite_.add("gate", over_the_gate);
  const Trace right = answers_of_reference(suite_[0])[0];
  const auto judged = [&](std::size_t tick, float wrong, std::optional<int> bits, Level level) {
    Trace answers = right;
    answers.samples[tick].out.actuator_controls_0.control[0] += wrong;
    Reciting port(answers);
    port.declarations_.fraction_bits = bits;
    const auto golden = Goldens(suite_.golden()).open(suite_[0]);
    return evaluate_case(suite_[0], Rate::hz(100), *golden, port, {level}).value();
  };
  const VectorResult near = judged(12, 0.1f, 16, Level::numeric);
  EXPECT_EQ(near.verdict, Verdict::skip);
  EXPECT_EQ(near.reason,
            "nearer to a decision of the law than 16 fraction bits resolve: thrust gate at tick "
            "10; the outputs deviate from tick 12 on");
  EXPECT_FALSE(near.first || near.compared || near.exact_only);
  EXPECT_EQ(judged(10, 0.1f, 16, Level::numeric).verdict, Verdict::skip);
  EXPECT_EQ(judged(12, 0.0f, 16, Level::numeric).verdict, Verdict::pass);
  // Before it; with more bits; in floating point; at another level; no number.
  EXPECT_EQ(judged(9, 0.1f, 16, Level::numeric).verdict, Verdict::fail);
  EXPECT_EQ(judged(12, 0.1f, 20, Level::numeric).verdict, Verdict::fail);
  EXPECT_EQ(judged(12, 0.1f, std::nullopt, Level::numeric).verdict, Verdict::fail);
  EXPECT_EQ(judged(12, 0.1f, 16, Level::exact).verdict, Verdict::fail);
  EXPECT_EQ(judged(12, std::numeric_limits<float>::infinity(), 16, Level::numeric).verdict,
            Verdict::non_finite);
}

// The port declares MC_PITCHRATE_P = 0.15, the default; the case sets 0.3.
TEST_F(EvaluateTest, AConstantThatThePortLetsChangeIsNoLack) {
  const std::string sets = std::string(pitching) + "[parameters]\nMC_PITCHRATE_P = 0.3\n";
  suite_.add("pitch", sets);
  const Trace right = answers_of_reference(suite_[0])[0];
  const auto judged = [&](Trace answers, const std::string& constant) {
    Reciting port(std::move(answers));
    port.declarations_.lacks = Lacks::parse(std::vector<std::string>{constant}).value();
    const auto golden = Goldens(suite_.golden()).open(suite_[0]);
    return evaluate_case(suite_[0], Rate::hz(100), *golden, port, {}).value();
  };
  const VectorResult has = judged(right, "MC_PITCHRATE_P=0.15");
  EXPECT_EQ(has.verdict, Verdict::unsupported);
  EXPECT_EQ(has.reason, "MC_PITCHRATE_P is 0.15 in the port, and this vector sets 0.3");
  EXPECT_THAT(has.has_after_all, testing::ElementsAre("MC_PITCHRATE_P"));
  Trace other = right;
  other.samples[9].out.actuator_controls_0.control[1] *= 0.5f;
  const VectorResult has_not = judged(other, "MC_PITCHRATE_P=0.15");
  EXPECT_EQ(has_not.reason, has.reason);
  EXPECT_THAT(has_not.lacking, testing::ElementsAre("MC_PITCHRATE_P"));
  EXPECT_TRUE(has_not.has_after_all.empty());
  // With 0.30001 the outputs are nearly the same, so that they show nothing.
  const VectorResult no_matter = judged(right, "MC_PITCHRATE_P=0.30001");
  EXPECT_EQ(no_matter.verdict, Verdict::unsupported);
  EXPECT_TRUE(no_matter.lacking.empty() && no_matter.has_after_all.empty());
}

// The case is unchanged, but its inputs are not: this happens if the harness changes.
TEST_F(EvaluateTest, AGoldenForOtherInputsIsAnError) {
  suite_.add_unblessed("pitch", pitching);
  Case other = suite_[0];
  other.parameters.push_back({"MC_PITCHRATE_P", Constant{0.3}});
  bless(suite_.golden(), other);
  const auto result = evaluate("builtin");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message,
              HasSubstr("tick 0, the reference of this build answers another"));
}

TEST_F(EvaluateTest, ARecordedTraceIsGivenToThePort) {
  suite_.add("pitch", pitching);
  Trace recorded = answers_of_reference(suite_[0])[0];
  recorded.source = "flight.csv";
  const auto judge = [&](const std::string& port) {
    return evaluate_trace(recorded, {"px4-v1.5.5"}, *opened(port), Tolerances());
  };
  EXPECT_EQ(judge("builtin").verdict, Verdict::pass);
  EXPECT_EQ(judge("builtin").name, "flight.csv");
  EXPECT_EQ(judge(test_port("sign_flip")).verdict, Verdict::fail);
  EXPECT_EQ(judge(test_port("refuses_profile")).verdict, Verdict::skip);
  recorded.samples[5].out.actuator_controls_0.control[3] += 0.5f;
  const VectorResult result = judge("builtin");
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->tick, 5u);
}

// Everything that a report shows, except the time that it took.
std::string shown(VectorResult result) {
  result.elapsed_s = 0;
  return to_json(result).dump();
}

// Returns ATTEST_UNSUPPORTED at tick 12.
class UnsupportedLater final : public PortHost {
 public:
  explicit UnsupportedLater(const std::string& port) : host_(opened(port)) {}

  const Declarations& declarations() const override { return host_->declarations(); }
  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) override {
    auto fault = host_->drive(subject, trace);
    if (fault || subject.part.first_tick + trace.samples.size() <= 12) return fault;
    return PortFault{PortFault::Kind::unsupported, 12, "step at tick 12 ..."};
  }
  Result<Flown> fly(const FlightPlan& plan) override { return host_->fly(plan); }
  Result<LiveFlight> fly_live(const LivePlan&, const LiveWatch&) override {
    return fail("no live flights");
  }
  Result<StepTimes> time_steps(const ModuleUnderTest& wanted, const Trace& inputs,
                               bool with_stack) override {
    return host_->time_steps(wanted, inputs, with_stack);
  }
  bool supports(const std::string& law) override { return host_->supports(law); }

 private:
  std::unique_ptr<PortHost> host_;
};

class PartsTest : public EvaluateTest {
 protected:
  void SetUp() override {
    suite_.add("pitch", pitching);
    recorded_ = answers_of_reference(suite_[0])[0];
    recorded_.source = "flight.csv";
  }

  // Expects the same result for parts of any size as for the whole trace.
  void expect_the_same(const std::function<std::unique_ptr<PortHost>()>& open,
                       Level level = Level::numeric) {
    const ModuleUnderTest subject{"px4-v1.5.5"};
    const Tolerances tolerances(level);
    const VectorResult whole = evaluate_trace(recorded_, subject, *open(), tolerances);
    for (const std::size_t most : {1U, 7U, 30U, 1000U}) {
      PartsOfTrace parts(recorded_);
      const auto host = open();
      const auto result = evaluate_parts(parts, subject, *host, tolerances, most);
      ASSERT_TRUE(result) << result.error().to_string();
      EXPECT_EQ(shown(*result), shown(whole)) << "parts of " << most;
    }
  }

  Trace recorded_;
};

TEST_F(PartsTest, OfAnySizeGiveTheResultOfTheWhole) {
  recorded_.parameters.push_back({9, "MC_PITCHRATE_P", 0.3f});
  recorded_.samples[9].in.updated |= ATTEST_UPDATED_PARAMETER_UPDATE;
  InProcessHost reference(open_builtin());
  ASSERT_FALSE(reference.drive({"px4-v1.5.5"}, recorded_));
  for (const Level level : {Level::exact, Level::numeric, Level::events}) {
    for (const std::string& port :
         {std::string("builtin"), std::string("fault:quat-order-state"), test_port("sign_flip"),
          test_port("step_fails"), test_port("unsupported_step"), test_port("refuses_profile"),
          test_port("non_finite"), test_port("fixed_step")}) {
      SCOPED_TRACE(port);
      expect_the_same([&] { return opened(port); }, level);
    }
  }
}

TEST_F(PartsTest, AreJudgedUpToTheTickThatIsUnsupported) {
  expect_the_same([] { return std::make_unique<UnsupportedLater>("builtin"); });
  expect_the_same([] { return std::make_unique<UnsupportedLater>(test_port("sign_flip")); });
  recorded_.samples[20].out.actuator_controls_0.control[3] += 0.5f;
  expect_the_same([] { return std::make_unique<UnsupportedLater>("builtin"); });
}

TEST_F(EvaluateTest, OnlyTheTicksThatThePortAnsweredAreItsOutputs) {
  suite_.add("pitch", pitching);
  const Trace recorded = answers_of_reference(suite_[0])[0];
  ASSERT_GT(recorded.samples.size(), 20u);
  for (const auto& [port, ticks] : std::map<std::string, std::size_t>{
           {test_port("step_fails"), 20}, {test_port("unsupported_step"), 0}}) {
    Trace got;
    evaluate_trace(recorded, {"px4-v1.5.5"}, *opened(port), Tolerances(), &got);
    EXPECT_EQ(got.samples.size(), ticks);
  }
}

TEST_F(EvaluateTest, AtTheEventsLevelAControllerIsJudgedByItsEvents) {
  suite_.add("pitch", pitching);
  Trace answers = answers_of_reference(suite_[0])[0];
  for (Sample& sample : answers.samples) sample.out.vehicle_rates_setpoint.pitch += 0.01f;
  Reciting port(answers);
  const auto golden = Goldens(suite_.golden()).open(suite_[0]);
  const auto verdict_at = [&](Level level) {
    return evaluate_case(suite_[0], Rate::hz(100), *golden, port, {level})->verdict;
  };
  EXPECT_EQ(verdict_at(Level::events), Verdict::pass);
  EXPECT_EQ(verdict_at(Level::numeric), Verdict::fail);
}

}  // namespace
}  // namespace attest
