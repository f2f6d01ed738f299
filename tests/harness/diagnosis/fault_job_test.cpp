#include "harness/diagnosis/fault_job.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/golden/blessed.hpp"

namespace attest {
namespace {

using testing::IsEmpty;

// A vector on which a missing attenuation changes the outputs: of a roll rate of 0.3 rad/s, P is
// 0.045.
std::string loud(double slope = 1) {
  return fmt::format(
      "[parameters]\nMC_TPA_BREAK = 0.3\nMC_TPA_SLOPE = {}\n[control_state]\nroll_rate = 0.3\n"
      "[vehicle_attitude_setpoint]\nthrust = 0.8\n",
      slope);
}

class FaultJobTest : public testing::Test {
 protected:
  // A case of 10 ticks at 100 and 250 Hz, with its golden.
  void add(const std::string& group, const std::string& name, const std::string& body) {
    add_unblessed(group, name, body);
    bless(golden(), cases_.back().the_case);
  }
  void add_unblessed(const std::string& group, const std::string& name, const std::string& body) {
    const auto parsed = parse_case(files_.write(
        group, name,
        fmt::format("schema = 1\nprofiles = [\"px4-v1.5.5\"]\ngroup = \"{}\"\nwhy = \"a test\"\n"
                    "duration_ticks = 10\nrates_hz = [100, 250]\nrates_why = \"two\"\n{}",
                    group, body)));
    ASSERT_TRUE(parsed) << parsed.error().to_string();
    cases_.push_back({*parsed, parsed->configurations()});
  }
  std::filesystem::path golden() const { return files_.folder().parent_path() / "golden"; }

  Result<FaultCatch> result_of(const faults::Fault& fault, std::optional<int> fraction_bits = {},
                               const std::string& profile = "px4-v1.5.5") const {
    const Goldens goldens(golden());
    return FaultJob(fault, profile, cases_, goldens, fraction_bits).run(0);
  }
  FaultCatch caught(const char* fault, std::optional<int> fraction_bits = {}) const {
    const auto result = result_of(*faults::find_fault(fault), fraction_bits);
    EXPECT_TRUE(result) << result.error().to_string();
    return result.value_or(FaultCatch());
  }

  std::vector<SelectedCase> cases_;

 private:
  CaseFiles files_;
};

TEST_F(FaultJobTest, AFaultThatACaseShowsIsCaughtByIt) {
  add("tpa", "level", "");
  add("tpa", "loud", loud());
  const FaultCatch found = caught("tpa-missing");
  EXPECT_EQ(found.verdict, Verdict::fail);
  EXPECT_TRUE(found.is_caught());
  EXPECT_EQ(found.by, "px4-v1.5.5/tpa/loud@250hz");
  EXPECT_EQ(found.tick, 0u);
}

TEST_F(FaultJobTest, AFaultThatNoCaseShowsSurvives) {
  add("tpa", "level", "");
  const FaultCatch found = caught("tpa-missing");
  EXPECT_EQ(found.verdict, Verdict::pass);
  EXPECT_FALSE(found.is_caught());
  EXPECT_THAT(found.by, IsEmpty());
  EXPECT_FALSE(found.tick);
}

TEST_F(FaultJobTest, TheTickIsTheFirstThatDeviates) {
  add("tpa", "louder",
      "[parameters]\nMC_TPA_BREAK = 0.3\n[control_state]\nroll_rate = 0.3\n"
      "[vehicle_attitude_setpoint]\n"
      "thrust = { signal = \"step\", from = 0.25, to = 0.8, at_ticks = 6 }\n");
  EXPECT_EQ(caught("tpa-missing").tick, 6u);
}

TEST_F(FaultJobTest, CasesOfItsOwnGroupComeFirst) {
  add("attitude", "loud", loud());
  add("tpa", "loud", loud());
  add("yaw", "loud", loud());
  EXPECT_EQ(caught("tpa-missing").by, "px4-v1.5.5/tpa/loud@250hz");
  cases_[1].configurations = {{Rate::hz(100), std::nullopt}};
  EXPECT_EQ(caught("tpa-missing").by, "px4-v1.5.5/tpa/loud@100hz");
  cases_.erase(cases_.begin() + 1);
  EXPECT_EQ(caught("tpa-missing").by, "px4-v1.5.5/attitude/loud@250hz");
}

TEST_F(FaultJobTest, OfAGroup250HzComesFirst) {
  add("tpa", "a", loud());
  add("tpa", "b", loud());
  cases_[0].configurations = {{Rate::hz(100), std::nullopt}};
  EXPECT_EQ(caught("tpa-missing").by, "px4-v1.5.5/tpa/b@250hz");
  cases_[1].configurations = {{Rate::hz(100), std::nullopt}};
  EXPECT_EQ(caught("tpa-missing").by, "px4-v1.5.5/tpa/a@100hz");
}

TEST_F(FaultJobTest, ACaseOfAnotherGroupCatchesWhatTheOwnDoesNot) {
  add("tpa", "level", "");
  add("yaw", "loud", loud());
  EXPECT_EQ(caught("tpa-missing").by, "px4-v1.5.5/yaw/loud@250hz");
}

TEST_F(FaultJobTest, CasesOnAThresholdAreJudgedAtTheExactLevel) {
  add("tpa", "loud", "level = \"exact\"\n" + loud());
  EXPECT_EQ(caught("tpa-missing").by, "px4-v1.5.5/tpa/loud@250hz");
}

// A slope of 1e-4 takes 2e-6 off the control, of which the numeric level allows 1e-4.
TEST_F(FaultJobTest, OnlyTheExactLevelSeesLastBits) {
  add("tpa", "nearly_flat", loud(1e-4));
  EXPECT_FALSE(caught("tpa-missing").is_caught());
  add("tpa", "nearly_flat_exactly", "level = \"exact\"\n" + loud(1e-4));
  EXPECT_EQ(caught("tpa-missing").by, "px4-v1.5.5/tpa/nearly_flat_exactly@250hz");
}

// An equivalent fault rounds in another way, which is a mistake at the exact level.
TEST_F(FaultJobTest, AnEquivalentFaultIsNotJudgedOnAThreshold) {
  const std::string turning =
      "[control_state]\n"
      "q = { tilt_deg = { signal = \"ramp\", from = 0, to = 60, end_ticks = 9 }, azimuth_deg = 30 "
      "}\n[vehicle_attitude_setpoint]\nq_d = { tilt_deg = 40, yaw_deg = 25 }\n";
  add("attitude", "turning", turning);
  add("attitude", "turning_exactly", "level = \"exact\"\n" + turning);
  EXPECT_FALSE(caught("yaw-added").is_caught());
  faults::Fault as_if_not = *faults::find_fault("yaw-added");
  as_if_not.equivalent = {};
  EXPECT_EQ(result_of(as_if_not).value().by, "px4-v1.5.5/attitude/turning_exactly@250hz");
}

TEST_F(FaultJobTest, AFaultOfWhatTheProfileLacksIsJudgedOnCasesOfItsGroupOnly) {
  add_unblessed("attitude", "level", "");
  const auto of_old_law = [this] {
    return result_of(*faults::find_fault("tpa-missing"), std::nullopt, "px4-v1.3.4");
  };
  const auto found = of_old_law();
  ASSERT_TRUE(found) << "no golden is needed";
  EXPECT_FALSE(found->is_caught());
  add_unblessed("tpa", "level", "");
  EXPECT_FALSE(of_old_law()) << "but here one is";
}

// A slope of 0.04 takes 9e-4 off the control: more than the 1e-4 of the numeric level, less than
// the 2560 of 2^-20 that a port with 20 bits may be off.
TEST_F(FaultJobTest, APortInFixedPointMayBeOffByMore) {
  add("tpa", "flat", loud(0.04));
  EXPECT_TRUE(caught("tpa-missing").is_caught());
  EXPECT_FALSE(caught("tpa-missing", 20).is_caught());
  EXPECT_TRUE(caught("tpa-missing", 28).is_caught());
}

TEST_F(FaultJobTest, AMissingGoldenIsAnError) {
  add_unblessed("tpa", "level", "");
  EXPECT_FALSE(result_of(*faults::find_fault("tpa-missing")));
}

TEST_F(FaultJobTest, AStaleGoldenIsAnError) {
  add("tpa", "level", "");
  cases_[0].the_case.sha256 = "another";
  EXPECT_FALSE(result_of(*faults::find_fault("tpa-missing")));
}

TEST(FaultCatch, ComesBackAsItWas) {
  const auto back = [](const Result<FaultCatch>& result) {
    return Codec<FaultCatch>::decode(Codec<FaultCatch>::encode(result));
  };
  const auto found = back(FaultCatch{Verdict::non_finite, "px4-v1.5.5/tpa/a@250hz", 0});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->verdict, Verdict::non_finite);
  EXPECT_EQ(found->by, "px4-v1.5.5/tpa/a@250hz");
  EXPECT_EQ(found->tick, 0u);
  const auto survived = back(FaultCatch());
  ASSERT_TRUE(survived);
  EXPECT_EQ(survived->verdict, Verdict::pass);
  EXPECT_FALSE(survived->tick);
  const auto error = back(fail("no golden"));
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message, "no golden");
}

TEST(FaultCatch, WhatFailsARunIsACatch) {
  for (const Verdict verdict :
       {Verdict::fail, Verdict::crash, Verdict::timeout, Verdict::protocol, Verdict::non_finite}) {
    EXPECT_TRUE((FaultCatch{verdict, "", {}}.is_caught())) << name_of(verdict);
  }
  for (const Verdict verdict : {Verdict::pass, Verdict::unsupported, Verdict::skip}) {
    EXPECT_FALSE((FaultCatch{verdict, "", {}}.is_caught())) << name_of(verdict);
  }
}

TEST(HuntFaultJob, FindsAFaultOfTheProfile) {
  const auto hunted = [](const char* fault, const char* profile) {
    const auto found = HuntFaultJob(*faults::find_fault(fault), profile, {}).run(0);
    EXPECT_TRUE(found) << found.error().to_string();
    return found.value_or(HuntCatch()).steps_before;
  };
  EXPECT_EQ(hunted("cascade-d-reversed", "px4-v1.16.0"), 0u);
  EXPECT_EQ(hunted("tpa-missing", "px4-v1.16.0"), std::nullopt);
}

TEST(HuntCatch, AHuntFindsWhatFailsInOneOfItsRounds) {
  const HuntCatch found{1000};
  EXPECT_FALSE(found.is_found_in(1000));  // which ends before that round
  EXPECT_TRUE(found.is_found_in(1001));
  EXPECT_FALSE(HuntCatch().is_found_in(1'000'000));
}

TEST(HuntCatch, ComesBackAsItWas) {
  const auto back = [](const Result<HuntCatch>& result) {
    return Codec<HuntCatch>::decode(Codec<HuntCatch>::encode(result));
  };
  EXPECT_EQ(back(HuntCatch{17}).value().steps_before, 17u);
  EXPECT_EQ(back(HuntCatch()).value().steps_before, std::nullopt);
  EXPECT_EQ(back(fail("no port")).error().message, "no port");
}

}  // namespace
}  // namespace attest
