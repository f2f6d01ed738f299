// The other instance of a port, before the judged one or at the same time.
#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/loop/open_loop.hpp"
#include "harness/loop/two_threads.hpp"
#include "tests/harness/loop/numbered_trace.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

using Kind = PortFault::Kind;

// Records the calls of its instances, of which at most `most_alive` may exist at a time.
class CountingPort final : public Port {
 public:
  std::string name() const override { return "counting"; }
  std::string version() const override { return "1"; }
  std::unique_ptr<Unit> create_unit(Module, const std::string& profile,
                                    const std::string&) override {
    const bool is_other = alive_ > 0 && profile != profile_;
    if (alive_ == most_alive || refused == profile || (one_profile_at_a_time && is_other)) {
      return nullptr;
    }
    ++alive_;
    profile_ = profile;
    calls.push_back(fmt::format("create {}{}", ++made_, profile == "any" ? "" : " " + profile));
    return std::make_unique<Counting>(*this, made_);
  }

  int most_alive = 9;
  bool one_profile_at_a_time = false;
  std::string refused;  // a profile
  std::vector<std::string> calls;

 private:
  class Counting final : public UnitOf<attest_inputs, attest_outputs> {
   public:
    Counting(CountingPort& port, int number) : port_(port), number_(number) {}
    ~Counting() override {
      port_.calls.push_back(fmt::format("destroy {}", number_));
      --port_.alive_;
    }
    int set_parameter(const std::string&, float) override { return ATTEST_OK; }
    int step(const attest_inputs& in, attest_outputs& out) override {
      port_.calls.push_back(fmt::format("step {} {:g}", number_, in.control_state.roll_rate));
      out.actuator_controls_0.control[0] = in.control_state.roll_rate;
      return ATTEST_OK;
    }

   private:
    CountingPort& port_;
    int number_;
  };

  int made_ = 0, alive_ = 0;
  std::string profile_;  // of the last instance
};

class Company : public testing::Test {
 protected:
  std::optional<PortFault> drive_with(Instances instances) {
    trace_ = trace_of(2);
    for (Sample& sample : trace_.samples) sample.in.control_state.roll_rate = 1;
    ModuleUnderTest subject{.profile = "any", .instances = instances};
    if (instances == Instances::other_profiles) subject.other_profiles = {"first", "second"};
    return drive(port_, subject, trace_);
  }

  CountingPort port_;
  Trace trace_;
};

TEST_F(Company, AgainDestroysTheOtherBeforeTheJudgedIsMade) {
  EXPECT_FALSE(drive_with(Instances::again));
  EXPECT_THAT(port_.calls, ElementsAre("create 1", "step 1 -0.53", "step 1 -0.53", "destroy 1",
                                       "create 2", "step 2 1", "step 2 1", "destroy 2"));
  EXPECT_EQ(trace_.samples[1].out.actuator_controls_0.control[0], 1);
}

TEST_F(Company, TogetherStepsThemAlternately) {
  EXPECT_FALSE(drive_with(Instances::together));
  EXPECT_THAT(port_.calls, ElementsAre("create 1", "create 2", "step 2 1", "step 1 -0.53",
                                       "step 2 1", "step 1 -0.53", "destroy 2", "destroy 1"));
}

TEST_F(Company, CrossedDestroysTheFirstWhileTheJudgedLives) {
  EXPECT_FALSE(drive_with(Instances::crossed));
  EXPECT_THAT(port_.calls, ElementsAre("create 1", "create 2", "step 1 -0.53", "step 1 -0.53",
                                       "destroy 1", "step 2 1", "step 2 1", "destroy 2"));
}

TEST_F(Company, AfterManyDestroysEachOfThemBeforeTheJudgedIsMade) {
  EXPECT_FALSE(drive_with(Instances::after_many));
  EXPECT_THAT(port_.calls,
              ElementsAre("create 1", "step 1 -0.53", "destroy 1", "create 2", "step 2 -0.53",
                          "destroy 2", "create 3", "step 3 1", "step 3 1", "destroy 3"));
}

TEST_F(Company, AmongManyMakesOneAfterEachStep) {
  EXPECT_FALSE(drive_with(Instances::among_many));
  EXPECT_THAT(port_.calls,
              ElementsAre("create 1", "step 1 1", "create 2", "step 2 -0.53", "destroy 2",
                          "step 1 1", "create 3", "step 3 -0.53", "destroy 3", "destroy 1"));
}

TEST_F(Company, OtherProfilesTakeTurnsFromBeforeTheJudgedOn) {
  EXPECT_FALSE(drive_with(Instances::other_profiles));
  EXPECT_THAT(port_.calls,
              ElementsAre("create 1 first", "step 1 -0.53", "destroy 1", "create 2", "step 2 1",
                          "create 3 second", "step 3 -0.53", "destroy 3", "step 2 1", "destroy 2"));
}

// Profiles next to each other may have the same law.
TEST(SubjectOf, TheOldestOtherProfileIsTheFirstUnlessItIsJudged) {
  Case the_case;
  the_case.instances = Instances::other_profiles;
  the_case.profiles = {"middle", "newest", "oldest"};
  const auto others = [&](const std::string& judged) {
    return subject_of(the_case.in_profile(judged)).other_profiles;
  };
  EXPECT_THAT(others("middle"), ElementsAre("oldest", "newest"));
  EXPECT_THAT(others("newest"), ElementsAre("oldest", "middle"));
  EXPECT_THAT(others("oldest"), ElementsAre("middle", "newest"));
}

TEST_F(Company, AProfileThatThePortDoesNotSupportIsReplacedByItsOwn) {
  port_.refused = "first";
  EXPECT_FALSE(drive_with(Instances::other_profiles));
  EXPECT_THAT(port_.calls, testing::Contains("create 1"));
  EXPECT_THAT(port_.calls, testing::Contains("create 3 second"));
}

TEST_F(Company, APortThatHasOneProfileAtATimeDoesNotSupportOthers) {
  port_.one_profile_at_a_time = true;
  trace_ = trace_of(3);
  const auto fault = drive(
      port_,
      ModuleUnderTest{
          .profile = "any", .instances = Instances::other_profiles, .other_profiles = {"first"}},
      trace_);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::unsupported);
  EXPECT_EQ(fault->what, "the port makes no unit of first while it has one of any");
}

// Its units have their input in a variable that they share while they step.
class SharingPort final : public Port {
 public:
  std::string name() const override { return "sharing"; }
  std::string version() const override { return "1"; }
  bool is_one_at_a_time() const override { return one_at_a_time; }
  std::unique_ptr<Unit> create_unit(Module, const std::string&, const std::string&) override {
    return std::make_unique<Sharing>();
  }

  bool one_at_a_time = false;

 private:
  class Sharing final : public UnitOf<attest_inputs, attest_outputs> {
   public:
    int set_parameter(const std::string&, float) override { return ATTEST_OK; }
    int step(const attest_inputs& in, attest_outputs& out) override {
      static std::atomic<float> shared;
      shared = in.control_state.roll_rate;
      for (std::atomic<int> turn = 0; turn < 100; ++turn) {
      }
      out.actuator_controls_0.control[0] = shared;
      return ATTEST_OK;
    }
  };
};

// Whether drive() shows the variable: by wrong outputs, or by those of two runs that differ.
bool shows_sharing(Instances instances, bool one_at_a_time) {
  SharingPort port;
  port.one_at_a_time = one_at_a_time;
  Trace trace = trace_of(3000);
  for (Sample& sample : trace.samples) sample.in.control_state.roll_rate = 1;
  const auto fault = drive(port, {.profile = "any", .instances = instances}, trace);
  EXPECT_TRUE(!fault || fault->kind == Kind::failed);
  return fault || std::ranges::any_of(trace.samples, [](const Sample& sample) {
           return sample.out.actuator_controls_0.control[0] != 1;
         });
}

TEST(TwoThreads, ShowAVariableThatAStepShares) {
  EXPECT_FALSE(shows_sharing(Instances::together, false));
  EXPECT_TRUE(shows_sharing(Instances::two_threads, false));
}

// How often two threads run. `of_a_run`: what each run adds.
std::size_t runs_until_overlapped(Overlaps of_a_run) {
  Trace trace = trace_of(3);
  std::size_t runs = 0;
  EXPECT_FALSE(run_until_overlapped(trace, [&](Trace&, Overlaps& overlaps) {
    ++runs;
    overlaps.whole += of_a_run.whole;
    overlaps.blocked += of_a_run.blocked;
    return std::optional<PortFault>();
  }));
  return runs;
}

TEST(TwoThreads, RunAgainUntilEnoughStepsOverlapOrAreBlocked) {
  EXPECT_EQ(runs_until_overlapped({.whole = 1000}), 1u);
  EXPECT_EQ(runs_until_overlapped({.whole = 101}), 3u);
  EXPECT_EQ(runs_until_overlapped({.whole = 101, .blocked = 15}), 2u);
}

TEST(TwoThreads, ARunThatDiffersFromTheFirstIsAFault) {
  Trace trace = trace_of(3);
  std::size_t runs = 0;
  const auto fault = run_until_overlapped(trace, [&](Trace& driven, Overlaps&) {
    if (++runs == 4) driven.samples[1].out.actuator_controls_0.control[0] = 1;
    return std::optional<PortFault>();
  });
  ASSERT_TRUE(fault);
  EXPECT_EQ(runs, 4u);
  EXPECT_EQ(fault->kind, PortFault::Kind::failed);
  EXPECT_EQ(fault->tick, 1u);
}

TEST(TwoThreads, AlternateForAPortThatIsOneAtATime) {
  EXPECT_FALSE(shows_sharing(Instances::two_threads, true));
}

// Notes what each of two rate units is given.
class RatePort final : public Port {
 public:
  class Noting final : public UnitOf<attest_rate_inputs, attest_rate_outputs> {
   public:
    Noting(std::vector<std::string>& notes, const std::string& refuses)
        : notes_(notes), refuses_(refuses) {}
    int set_parameter(const std::string& name, float value) override {
      notes_.push_back(fmt::format("{}={}", name, value));
      return name == refuses_ ? ATTEST_INVALID : ATTEST_OK;
    }
    int step(const attest_rate_inputs& in, attest_rate_outputs&) override {
      notes_.push_back(fmt::format(
          "{} {} {} updated {:x}", in.vehicle_angular_velocity.timestamp_sample,
          in.vehicle_angular_velocity.xyz[1], in.vehicle_control_mode.flag_armed, in.updated));
      return ATTEST_OK;
    }

   private:
    std::vector<std::string>& notes_;
    std::string refuses_;
  };

  std::string name() const override { return "rate"; }
  std::string version() const override { return "1"; }
  ModuleSet modules() const override { return only(Module::rate_unit); }
  std::unique_ptr<Unit> create_unit(Module, const std::string&, const std::string&) override {
    return std::make_unique<Noting>(notes, refuses);
  }

  std::string refuses;  // the name of a parameter
  std::vector<std::string> notes;
};

class CompanyOfAUnit : public testing::Test {
 protected:
  // The notes of the other instance; those of the judged one follow them.
  std::vector<std::string> notes_of(Trace trace, const std::string& profile = "px4-v1.16.0") {
    ModuleUnderTest subject{.profile = profile, .module = Module::rate_unit};
    subject.instances = Instances::again;
    EXPECT_FALSE(drive(port_, subject, trace));
    return port_.notes;
  }

  RatePort port_;
};

TEST_F(CompanyOfAUnit, HasOtherInputsAndParameters) {
  Trace trace = trace_of(1);
  trace.parameters = {{0, "MC_YAWRATE_P", 0.5f}, {0, "MC_BAT_SCALE_EN", 1}};
  auto& in = trace.samples[0].rate_in;
  in.vehicle_angular_velocity.timestamp_sample = 7;
  in.vehicle_angular_velocity.xyz[1] = 3;
  in.vehicle_control_mode.flag_armed = 1;
  const std::vector<std::string> notes = notes_of(trace);
  EXPECT_THAT(notes, testing::IsSupersetOf({"MC_PITCHRATE_D=0.00225", "MC_YAWRATE_D=0.25"}));
  ASSERT_GE(notes.size(), 6);
  EXPECT_THAT(std::vector(notes.end() - 6, notes.end()),
              ElementsAre("MC_YAWRATE_P=0.375", "MC_BAT_SCALE_EN=0", "1007 -1.73 0 updated 17f",
                          "MC_YAWRATE_P=0.5", "MC_BAT_SCALE_EN=1", "7 3 1 updated 0"));
}

TEST_F(CompanyOfAUnit, HasOtherFlagsAtEverySecondTick) {
  EXPECT_THAT(
      notes_of(trace_of(3), "own"),
      ElementsAre("1000 0.07 1 updated 17f", "1000 0.07 0 updated 17f", "1000 0.07 1 updated 17f",
                  "0 0 0 updated 0", "0 0 0 updated 0", "0 0 0 updated 0"));
}

TEST_F(CompanyOfAUnit, MayLackAParameterThatTheTraceDoesNotSet) {
  port_.refuses = "MC_YAWRATE_D";
  EXPECT_THAT(notes_of(trace_of(1)), testing::Contains("MC_YAWRATE_D=0.25"));
}

TEST_F(Company, APortThatMakesOneInstanceDoesNotSupportTwo) {
  port_.most_alive = 1;
  const auto fault = drive_with(Instances::together);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::unsupported);
  EXPECT_FALSE(drive_with(Instances::again));
  EXPECT_FALSE(drive_with(Instances::after_many));
}

}  // namespace
}  // namespace attest
