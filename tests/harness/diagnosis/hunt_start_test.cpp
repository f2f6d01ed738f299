#include "harness/diagnosis/hunt_start.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/compare/input_difference.hpp"
#include "harness/diagnosis/hunt_job.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

Case parsed(const std::string& text, const std::string& profile) {
  auto made = parse_case_text(text, fmt::format("cases/{}/{}/one.toml", profile, hunt_group));
  EXPECT_TRUE(made) << made.error().to_string();
  return *made;
}

std::vector<HuntTarget> targets_of(Level level) {
  std::vector<HuntTarget> targets;
  for (const ProfileInfo& profile : known_profiles()) {
    for (const ModuleInfo& info : modules()) {
      if (!contains(profile.modules, info.module)) continue;
      HuntTarget target;
      target.subject = {std::string(profile.name), info.module};
      target.level = level;
      targets.push_back(target);
    }
  }
  return targets;
}

// So a case of a corpus is the same trial in each hunt, and is added once.
TEST(HuntStart, ACaseOfATrialIsTheTrial) {
  for (const Level level : {Level::numeric, Level::exact}) {
    for (const HuntTarget& target : targets_of(level)) {
      for (std::uint64_t number = 0; number < 2; ++number) {
        const HuntInputs inputs = make_trial(target, 1, number, {});
        if (inputs.steps() > 1000) continue;
        const auto text = case_of(inputs, level);
        ASSERT_TRUE(text) << text.error().to_string();
        const auto trials = trials_of_case(parsed(*text, target.subject.profile), inputs.rate);
        ASSERT_EQ(trials.size(), 1u) << *text;
        EXPECT_EQ(trials[0].steps(), inputs.steps());
        EXPECT_EQ(trials[0].start_us, inputs.start_us);
        EXPECT_EQ(case_of(fit_trial(target, trials[0]), level).value_or(""), *text);
      }
    }
  }
}

const char* const rate_unit_case = R"(
schema = 1
profiles = ["px4-v1.16.0"]
group = "hunt"
module = "rate_unit"
why = "a test"
rates_hz = [1000]
rates_why = "a test"
duration_ticks = {}
[vehicle_land_detected]
landed = 1
[parameters]
MC_ROLLRATE_P = {{ signal = "samples", times_ticks = [0, 1200], values = [0.2, 0.3] }}
[vehicle_angular_velocity]
"xyz[0]" = {}
)";

TEST(HuntStart, ALongCaseIsCut) {
  const Case the_case =
      parsed(fmt::format(fmt::runtime(rate_unit_case), 2500,
                         "{ signal = \"ramp\", from = 0, to = 1, end_ticks = 2500 }"),
             "px4-v1.16.0");
  const auto trials = trials_of_case(the_case, Rate::hz(1000));
  ASSERT_EQ(trials.size(), 3u);
  EXPECT_EQ(trials[0].steps() + trials[1].steps() + trials[2].steps(), 2500u);
  EXPECT_EQ(trials[1].start_us, trials[0].start_us + 1'000'000);
  // What was published before the part is new at its first tick.
  for (const HuntInputs& trial : trials) {
    EXPECT_NE(trial.ticks[0].sample.in.updated, 0u);
    EXPECT_EQ(trial.ticks[1].sample.in.updated, 0u);
  }
  ASSERT_EQ(trials[1].parameters.size(), 2u);
  EXPECT_EQ(trials[1].parameters[0].value, 0.2F);
  EXPECT_EQ(trials[1].parameters[1].tick, 200u);
  ASSERT_EQ(trials[2].parameters.size(), 1u);
  EXPECT_EQ(trials[2].parameters[0].value, 0.3F);
}

TEST(HuntStart, ManyTicksWithoutNewsAreQuietOnes) {
  const Case the_case =
      parsed(fmt::format(fmt::runtime(rate_unit_case), 100'000, "0.5"), "px4-v1.16.0");
  const auto trials = trials_of_case(the_case, Rate::hz(1000));
  ASSERT_EQ(trials.size(), 1u);
  EXPECT_EQ(trials[0].steps(), 100'000u);
  EXPECT_LT(trials[0].ticks.size(), 100u);
  EXPECT_FALSE(
      first_input_difference(*whole_trace_of(trials[0]), stimulate(the_case, Rate::hz(1000))));
}

}  // namespace
}  // namespace attest
