// A port gives the same answers in a process of its own as in this one. Every failure there becomes
// a fault of the request.
#include "harness/host/port_process.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/trace/trace_parts.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;
using Kind = PortFault::Kind;

const std::filesystem::path source = ATTEST_SOURCE_DIR;

std::unique_ptr<PortHost> host_of(const std::string& port, bool in_process = false,
                                  const Course& course = {}, double timeout_s = 60) {
  HostOptions options;
  options.port =
      port == "builtin" ? port : fmt::format("lib:{}/port_{}.so", ATTEST_TEST_PORTS, port);
  options.in_process = in_process;
  options.timeout_s = timeout_s;
  auto host = start_host(options, course);
  EXPECT_TRUE(host) << host.error().to_string();
  return host ? *std::move(host) : nullptr;
}

// A trace with more ticks than the ports of tests/ports stay right for.
Trace pitching() {
  Case the_case = case_of(
      "[control_state]\n"
      "pitch_rate = { signal = \"step\", from = 0, to = 0.5, at_ticks = 3 }\n"
      "[parameters]\nMC_PITCHRATE_P = 0.3\n");
  the_case.duration = {30, Span::In::ticks};
  return stimulate(the_case, Rate::hz(250));
}

// Compared by channel, because the padding of a struct has no meaning.
bool same_samples(const std::vector<Sample>& one, const std::vector<Sample>& other) {
  return std::equal(
      one.begin(), one.end(), other.begin(), other.end(), [](const Sample& a, const Sample& b) {
        return std::all_of(channels().begin(), channels().end(), [&](const Channel& channel) {
          const double x = value_of(channel, a);
          const double y = value_of(channel, b);
          return std::memcmp(&x, &y, sizeof x) == 0;
        });
      });
}

const ModuleUnderTest unit{"px4-v1.5.5"};

TEST(PortProcess, DrivesAsHere) {
  for (const std::string port : {"builtin", "sign_flip"}) {
    Trace here = pitching(), apart = pitching();
    EXPECT_FALSE(host_of(port, true)->drive(unit, here));
    const auto host = host_of(port);
    for (int twice = 0; twice < 2; ++twice) {
      EXPECT_FALSE(host->drive(unit, apart));
      EXPECT_TRUE(same_samples(here.samples, apart.samples)) << port;
    }
    EXPECT_NE(here.samples[5].out.actuator_controls_0.control[1], 0);
    EXPECT_EQ(apart.parameters, here.parameters);
  }
}

TEST(PortProcess, TheLastWordsAreThoseOfTheLastTrace) {
  const auto host = host_of("prints");
  Trace trace = pitching();
  EXPECT_FALSE(host->drive(unit, trace));
  EXPECT_EQ(host->last_words(), "a note on step 29");
  trace.samples.clear();
  EXPECT_FALSE(host->drive(unit, trace));
  EXPECT_EQ(host->last_words(), "");
}

TEST(PortProcess, DrivesTheSameInParts) {
  for (const std::string port : {"builtin", "sign_flip"}) {
    Trace whole = pitching();
    EXPECT_FALSE(host_of(port, true)->drive(unit, whole));
    const auto host = host_of(port);
    for (const std::size_t most : {1U, 7U, 30U}) {
      PartsOfTrace parts(whole);
      ModuleUnderTest subject = unit;
      std::vector<Sample> answered;
      ASSERT_TRUE(for_each_part(parts, most, [&](Trace part, std::size_t first, bool is_last) {
        for (Sample& sample : part.samples) sample.clear_outputs();
        subject.part = {first, is_last};
        EXPECT_FALSE(host->drive(subject, part));
        answered.insert(answered.end(), part.samples.begin(), part.samples.end());
        return true;
      }));
      EXPECT_TRUE(same_samples(whole.samples, answered)) << port << ", parts of " << most;
    }
  }
}

// The process gets it in several requests, and keeps the integral.
TEST(PortProcess, DrivesALongTraceAsHere) {
  Case the_case =
      case_of("[control_state]\npitch_rate = 0.001\n[parameters]\nMC_PITCHRATE_I = 0.3\n");
  the_case.duration = {2 * ticks_at_once + 1, Span::In::ticks};
  Trace here = stimulate(the_case, Rate::hz(250)), apart = here;
  EXPECT_FALSE(host_of("builtin", true)->drive(unit, here));
  EXPECT_FALSE(host_of("builtin")->drive(unit, apart));
  EXPECT_TRUE(same_samples(here.samples, apart.samples));
  const auto integral = [&](std::size_t tick) {
    return here.samples[tick].out.mc_att_ctrl_status.pitch_rate_integ;
  };
  EXPECT_NE(integral(2 * ticks_at_once), integral(ticks_at_once));
}

// As after a mistake in the middle of a file.
TEST(PortProcess, ATraceThatWasNotDrivenToItsEndLeavesNoInstance) {
  Trace first = pitching(), whole = pitching();
  const auto host = host_of("builtin");
  ModuleUnderTest part = unit;
  part.part = {0, false};
  EXPECT_FALSE(host->drive(part, first));
  EXPECT_FALSE(host->drive(part, whole));
  EXPECT_TRUE(same_samples(first.samples, whole.samples));
}

TEST(PortProcess, AFaultInALaterPartHasTheTickOfTheTrace) {
  Trace whole = pitching();
  const auto expected = host_of("step_fails", true)->drive(unit, whole);
  ASSERT_TRUE(expected);
  const auto host = host_of("step_fails");
  PartsOfTrace parts(whole);
  ModuleUnderTest subject = unit;
  std::optional<PortFault> fault;
  ASSERT_TRUE(for_each_part(parts, 7, [&](Trace part, std::size_t tick, bool is_last) {
    subject.part = {tick, is_last};
    fault = host->drive(subject, part);
    return !fault;
  }));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->tick, expected->tick);
  EXPECT_THAT(fault->what, StartsWith(expected->what));
}

TEST(PortProcess, FliesAsHere) {
  const auto hover = parse_case(source / "cases/px4-v1.5.5/flight/hover.toml");
  ASSERT_TRUE(hover);
  const auto iris = *VehicleModel::load(source / "models", "iris");
  const Course course{&*hover, iris.get()};
  FlightPlan plan{{Rate::hz(50), PlantConfiguration{"iris", PlantKind::ode}},
                  case_timing(*hover, Rate::hz(50))};
  plan.timing.unit.resize(100);
  const auto here = host_of("builtin", true, course)->fly(plan);
  const auto apart = host_of("builtin", false, course)->fly(plan);
  ASSERT_TRUE(here && apart);
  ASSERT_EQ(apart->trace.samples.size(), 100u);
  EXPECT_TRUE(same_samples(here->trace.samples, apart->trace.samples));
  EXPECT_EQ(here->trace.parameters, apart->trace.parameters);
  EXPECT_EQ(here->trace.plant.size(), apart->trace.plant.size());
  EXPECT_EQ(here->trace.source, apart->trace.source);
  EXPECT_TRUE(here->trace.present == apart->trace.present);
}

// In this process and in another: the flight that the plan has, or the part before a request to
// stop.
TEST(PortProcess, FliesInRealTimeUntilItIsAskedToStop) {
  Case hover = *parse_case(source / "cases/px4-v1.5.5/flight/hover.toml");
  const auto iris = *VehicleModel::load(source / "models", "iris");
  const int cpu = usable_cpus().front();
  const LivePlan plan{
      {Rate::hz(100), PlantConfiguration{"iris", PlantKind::mujoco}}, {cpu, cpu, false, {}}, 5};
  for (const bool in_process : {true, false}) {
    const auto host = host_of("builtin", in_process, {&hover, iris.get()});
    for (const double duration_s : {600.0, 0.3}) {
      hover.duration = {duration_s, Span::In::seconds};
      LiveProgress seen;
      const LiveWatch watch{[&] { return duration_s > 1 && seen.time > Nanoseconds(0); },
                            [&](const LiveProgress& now) { seen = now; }};
      const auto flight = host->fly_live(plan, watch);
      ASSERT_TRUE(flight) << flight.error().to_string();
      EXPECT_FALSE(flight->fault) << flight->fault->what;
      const LiveUnitRecord& flown = flight->unit;
      EXPECT_EQ(flown.samples.size(), std::min<std::size_t>(flown.ticks.size(), 5));
      EXPECT_GT(flight->plant.steps(), 0u);
      EXPECT_FALSE(flight->privileges.empty());
      if (duration_s < 1) {
        EXPECT_EQ(flown.ticks.size() + flown.skipped, 30u);
      } else {
        EXPECT_LT(flown.ticks.size() + flown.skipped, 60'000u);
      }
    }
  }
}

TEST(PortProcess, TimesEachStep) {
  const auto times = host_of("builtin")->time_steps({"px4-v1.5.5"}, pitching(), true);
  ASSERT_TRUE(times) << times.error().to_string();
  EXPECT_EQ(times->steps.size(), pitching().samples.size());
  EXPECT_GT(*std::max_element(times->steps.begin(), times->steps.end()), Nanoseconds(0));
  EXPECT_GT(times->stack_bytes.value_or(0), 0u);
}

TEST(PortProcess, TimesEachStepOfAUnitOfTheCascade) {
  Trace level;
  level.samples.resize(20);
  for (std::size_t i = 0; i < level.samples.size(); ++i) {
    level.samples[i].in.timestamp = 5'000'000 + 1000 * i;
  }
  const ModuleUnderTest rate_unit{"px4-v1.16.0", Module::rate_unit};
  const auto times = host_of("builtin")->time_steps(rate_unit, level, true);
  ASSERT_TRUE(times) << times.error().to_string();
  EXPECT_FALSE(times->fault);
  EXPECT_EQ(times->steps.size(), 20u);
  EXPECT_GT(times->stack_bytes.value_or(0), 0u);
  const auto lacking = host_of("silent")->time_steps(rate_unit, level, false);
  ASSERT_TRUE(lacking && lacking->fault);
  EXPECT_EQ(lacking->fault->kind, Kind::profile);
}

TEST(PortProcess, ItsDeathIsTheFaultOfTheRequestAndOfAllThatFollow) {
  const auto host = host_of("crash");
  Trace trace = pitching();
  const auto fault = host->drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::crash);
  EXPECT_THAT(fault->what, HasSubstr("the port's process "));
  EXPECT_THAT(fault->what, HasSubstr(" in step() at tick 20"));
  EXPECT_TRUE(host->is_spent());
  const auto later = host->drive(unit, trace);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->kind, Kind::crash);
  EXPECT_EQ(later->what, "not run: the port had crashed or broken the protocol before");
}

TEST(PortProcess, AHangIsWaitedForOnce) {
  const auto host = host_of("hang", false, {}, 0.2);
  Trace trace = pitching();
  const auto fault = host->drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::timeout);
  EXPECT_EQ(fault->what, "no answer within 0.2 s of CPU time in step() at tick 20");
  EXPECT_EQ(host->drive(unit, trace)->what, "not run: the port had timed out before");
  EXPECT_FALSE(host->is_spent());
}

TEST(PortProcess, OneThatHangsWhenItIsLoadedSaysSoOnce) {
  const auto host = host_of("hangs_in_load", false, {}, 0.2);
  Trace trace = pitching();
  EXPECT_EQ(host->drive(unit, trace)->what,
            "no answer within 0.2 s of CPU time, when it was loaded");
  EXPECT_EQ(host->drive(unit, trace)->what, "not run: the port had timed out before");
}

TEST(PortProcess, OneThatIsKnownToHangIsNotStarted) {
  HostOptions options;
  options.port = "lib:/does/not/exist.so";
  options.hangs = "no answer within 10 s, when it was loaded";
  const auto host = start_host(options);
  ASSERT_TRUE(host) << host.error().to_string();
  Trace trace = pitching();
  const auto fault = (*host)->drive(unit, trace);
  EXPECT_EQ(fault->kind, Kind::timeout);
  EXPECT_EQ(fault->what, options.hangs);
}

TEST(PortProcess, WhatTheStepSaysComesBack) {
  Trace trace = pitching();
  const auto fault = host_of("step_fails")->drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::failed);
  EXPECT_EQ(fault->tick, 20u);
  const auto refusal = host_of("refuses_profile")->drive(unit, trace);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->kind, Kind::profile);
  EXPECT_EQ(refusal->what, "the port does not support profile px4-v1.5.5");
}

TEST(PortProcess, APortIsHeldToWhatItSaid) {
  HostOptions options;
  options.said = Declarations{"another", "1", {}, {}, {}, {}, ModuleSet(), {}};
  const auto host = start_host(options);
  ASSERT_TRUE(host);
  Trace trace = pitching();
  const auto fault = (*host)->drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::protocol);
  EXPECT_THAT(fault->what, HasSubstr("it was `another` when the port was asked first"));
}

TEST(PortProcess, WaitingEndsWhenTheAnswerDoesNotMatter) {
  HostOptions options;
  options.port = fmt::format("lib:{}/port_hang.so", ATTEST_TEST_PORTS);
  options.timeout_s = 60;
  bool was_looked_at = false;
  options.stop = [&] { return std::exchange(was_looked_at, true); };
  const auto host = start_host(options);
  ASSERT_TRUE(host);
  Trace trace = pitching();
  EXPECT_EQ((*host)->drive(unit, trace)->kind, Kind::timeout);
}

TEST(PortProcess, AFlightOfAFixedStepBeginsOnePeriodAfterZero) {
  const auto hover = parse_case(source / "cases/px4-v1.5.5/flight/hover.toml");
  ASSERT_TRUE(hover);
  const auto iris = *VehicleModel::load(source / "models", "iris");
  FlightPlan plan{{Rate::hz(50), PlantConfiguration{"iris", PlantKind::ode}},
                  case_timing(*hover, Rate::hz(50))};
  plan.timing.unit.resize(3);
  for (const bool from_one_period_on : {false, true}) {
    plan.from_one_period_on = from_one_period_on;
    const auto flown = host_of("builtin", false, {&*hover, iris.get()})->fly(plan);
    ASSERT_TRUE(flown) << flown.error().to_string();
    EXPECT_EQ(flown->trace.samples[0].in.timestamp, from_one_period_on ? 20'000u : 5'000'000u);
  }
}

TEST(PortProcess, DeathInTheMiddleOfAnAnswerIsACrash) {
  Trace trace = pitching();
  const auto fault = host_of("dies_in_answer")->drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::crash);
  EXPECT_THAT(fault->what, HasSubstr("exited with status 3"));
}

TEST(DeclarationsTest, EachChangedAnswerOfAPortIsReported) {
  const Declarations said{"a", "1", {"rates"}, {}, 22, Rate::hz(250), ModuleSet().set(), {}};
  EXPECT_EQ(change(said, said), "");
  std::vector<Declarations> others(8, said);
  others[0].name = "b";
  others[1].version = "2";
  others[2].unsupported_groups = {"rates", "tpa"};
  others[3].fraction_bits = 20;
  others[4].fraction_bits.reset();
  others[5].fixed_step = Rate::hz(500);
  others[6].modules = only(Module::mc_att_control);
  others[7].lacks = *Lacks::parse(std::vector<std::string>{"sticks"});
  for (const Declarations& now : others) EXPECT_NE(change(said, now), "");
}

}  // namespace
}  // namespace attest
