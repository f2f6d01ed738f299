#include "harness/diagnosis/hunt_generator.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/compare/input_difference.hpp"
#include "harness/diagnosis/hunt_lacks.hpp"
#include "harness/diagnosis/hunt_trace.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Ge;
using testing::Le;

HuntTarget target_of(Module module, const std::string& profile, Level level = Level::numeric) {
  HuntTarget target;
  target.subject = {profile, module};
  target.level = level;
  return target;
}

std::vector<HuntTarget> all_targets(Level level = Level::numeric) {
  std::vector<HuntTarget> targets;
  for (const ProfileInfo& profile : known_profiles()) {
    for (const ModuleInfo& info : modules()) {
      if (!contains(profile.modules, info.module)) continue;
      targets.push_back(target_of(info.module, std::string(profile.name), level));
    }
  }
  return targets;
}

std::string label(const HuntTarget& target, std::uint64_t trial) {
  return fmt::format("{} of {}, trial {}", name_of(target.subject.module), target.subject.profile,
                     trial);
}

// The first `count` trials of the seed. Those after the first twelve may vary them.
std::vector<HuntInputs> trials_of(const HuntTarget& target, std::uint64_t count,
                                  std::uint64_t seed = 1) {
  std::vector<HuntInputs> trials, kept;
  for (std::uint64_t trial = 0; trial < count; ++trial) {
    trials.push_back(make_trial(target, seed, trial, kept));
    if (trial < 12) kept.push_back(trials.back());
    for (HuntTick& tick : kept.back().ticks) tick.quiet = 0;
  }
  return trials;
}

bool are_same(const HuntInputs& one, const HuntInputs& other) {
  return one.rate == other.rate && one.steps() == other.steps() && one.start_us == other.start_us &&
         !first_input_difference(inputs_of(one), inputs_of(other));
}

TEST(HuntGenerator, ATrialIsAFunctionOfSeedNumberAndKeptInputs) {
  for (const HuntTarget& target : all_targets()) {
    const auto once = trials_of(target, 24), again = trials_of(target, 24);
    const auto others = trials_of(target, 24, 2);
    std::size_t same = 0;
    for (std::size_t i = 0; i < once.size(); ++i) {
      EXPECT_TRUE(are_same(once[i], again[i])) << label(target, i);
      same += are_same(once[i], others[i]) ? 1 : 0;
    }
    EXPECT_LE(same, 1u) << label(target, 0);
    EXPECT_FALSE(are_same(once[0], once[1])) << label(target, 0);
  }
}

void expect_in_range(const HuntTarget& target, const HuntInputs& inputs, const std::string& what) {
  EXPECT_THAT(inputs.ticks.size(), AllOf(Ge(1u), Le(600u))) << what;
  EXPECT_LE(inputs.steps(), 110'000u) << what;
  const ModuleInfo& info = info_of(target.subject.module);
  if (!info.default_rates_hz.empty()) {
    const bool is_usual = std::ranges::any_of(info.default_rates_hz,
                                              [&](int hz) { return inputs.rate == Rate::hz(hz); });
    EXPECT_TRUE(is_usual) << what << " at " << inputs.rate.label();
  }
  for (const ParameterChange& change : inputs.parameters) {
    EXPECT_LT(change.tick, inputs.ticks.size()) << what << ", " << change.name;
    EXPECT_TRUE(check_parameter(target.subject, change)) << what << ", " << change.name;
  }
  const bool is_sorted = std::ranges::is_sorted(inputs.parameters, {}, &ParameterChange::tick);
  EXPECT_TRUE(is_sorted) << what;
}

TEST(HuntGenerator, TrialsAreInRange) {
  for (const Level level : {Level::numeric, Level::exact}) {
    for (const HuntTarget& target : all_targets(level)) {
      const auto trials = trials_of(target, 60);
      for (std::size_t i = 0; i < trials.size(); ++i) {
        expect_in_range(target, trials[i], label(target, i));
      }
    }
  }
}

// Whether a float input is infinite, or too large for a flight.
bool has_extreme(const HuntInputs& inputs) {
  const Trace trace = inputs_of(inputs);
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!trace.present[i] || channel.is_output() || channel.type != ChannelType::f32) continue;
    for (const Sample& sample : trace.samples) {
      const float value = float_of(channel, sample);
      if (std::isinf(value) || std::abs(value) > 1e6F) return true;
    }
  }
  return false;
}

TEST(HuntGenerator, InfinitiesAndLargeValuesAreTriedAtTheLevelExactOnly) {
  const auto count_at = [](Level level) {
    const auto trials = trials_of(target_of(Module::rate_unit, "px4-v1.16.0", level), 200);
    return std::ranges::count_if(trials, has_extreme);
  };
  EXPECT_EQ(count_at(Level::numeric), 0);
  EXPECT_GT(count_at(Level::exact), 10);
}

TEST(HuntGenerator, TheRecoveryOfATailsitterIsNotHuntedToTheBit) {
  const auto count_at = [](Level level) {
    const auto trials = trials_of(target_of(Module::mc_att_control, "px4-v1.5.5", level), 200);
    return std::ranges::count_if(trials, [](const HuntInputs& inputs) {
      return std::ranges::any_of(inputs.parameters, [](const ParameterChange& change) {
        return change.name == "VT_OPT_RECOV_EN";
      });
    });
  };
  EXPECT_EQ(count_at(Level::exact), 0);
  EXPECT_GT(count_at(Level::numeric), 10);
}

TEST(HuntGenerator, APortWithAFixedStepGetsItsTimes) {
  HuntTarget target = target_of(Module::rate_unit, "px4-v1.16.0");
  target.fixed_step = Rate::hz(400);
  for (const HuntInputs& inputs : trials_of(target, 50)) {
    EXPECT_EQ(inputs.rate, Rate::hz(400));
    for (const HuntTick& tick : inputs.ticks) EXPECT_EQ(tick.periods, 1u);
  }
}

TEST(HuntGenerator, InputsOfACaseFitThePort) {
  HuntTarget target = target_of(Module::rate_unit, "px4-v1.16.0");
  const HuntInputs inputs = make_trial(target, 1, 4, {});
  EXPECT_TRUE(are_same(fit_trial(target, inputs), inputs));
  target.fixed_step = Rate::hz(400);
  target.lacks.features = only(Feature::arming);
  const HuntInputs fit = fit_trial(target, inputs);
  EXPECT_EQ(fit.rate, Rate::hz(400));
  EXPECT_EQ(fit.start_us, 2500u);
  for (const HuntTick& tick : fit.ticks) EXPECT_EQ(tick.periods, 1u);
  EXPECT_FALSE(uses_lacking(target.lacks, fit));
  HuntTarget exact = target_of(Module::mc_att_control, "px4-v1.5.5", Level::exact);
  HuntInputs recovers = make_trial(exact, 1, 0, {});
  recovers.parameters.push_back({0, "VT_OPT_RECOV_EN", 1});
  for (const ParameterChange& change : fit_trial(exact, recovers).parameters) {
    EXPECT_NE(change.name, "VT_OPT_RECOV_EN");
  }
}

TEST(HuntGenerator, TheBeginOfATrialMeetsWhatTheTrialMeets) {
  const HuntTarget target = target_of(Module::rate_unit, "px4-v1.16.0");
  const HuntInputs inputs = make_trial(target, 1, 5, {});
  const auto met_by = [](const HuntInputs& trial) {
    HuntFeatures met;
    Trace whole;
    EXPECT_TRUE(HuntTrace(trial, &met).next_part(whole_trace, whole));
    return met;
  };
  const HuntFeatures all = met_by(inputs);
  EXPECT_EQ(met_by(begin_that_meets(all, inputs)), all);
  HuntInputs short_one = inputs;
  short_one.ticks.resize(3);
  std::erase_if(short_one.parameters,
                [](const ParameterChange& change) { return change.tick > 2; });
  const HuntFeatures few = met_by(short_one);
  const HuntInputs begin = begin_that_meets(few, inputs);
  EXPECT_LE(begin.ticks.size(), 4u) << "of " << inputs.ticks.size();
  EXPECT_EQ(met_by(begin) & few, few);
}

TEST(HuntGenerator, TrialsUseNoFeatureThatThePortLacks) {
  for (HuntTarget target : all_targets()) {
    for (std::size_t feature = 0; feature < feature_count; ++feature) {
      target.lacks.features = only(static_cast<Feature>(feature));
      for (std::uint64_t trial = feature; trial < feature + 2; ++trial) {
        EXPECT_FALSE(uses_lacking(target.lacks, make_trial(target, 1, trial, {})))
            << label(target, trial) << " uses " << features()[feature].name;
      }
    }
    target.lacks.features.set();
    EXPECT_FALSE(uses_lacking(target.lacks, make_trial(target, 1, 0, {}))) << label(target, 0);
  }
}

// What a port has is tried as before: only what it lacks has the baseline.
TEST(HuntGenerator, TrialsStillUseTheOtherFeatures) {
  HuntTarget target = target_of(Module::rate_unit, "px4-v1.16.0");
  target.lacks.features = only(Feature::arming) | only(Feature::mode_changes);
  FeatureSet used;
  for (const HuntInputs& inputs : trials_of(target, 60)) {
    used |= features_of(inputs_of(inputs), target.subject.profile);
  }
  const auto names = names_of(used);
  for (const char* name : {"acro", "saturation", "landing", "battery", "parameter_changes"}) {
    EXPECT_THAT(names, Contains(name));
  }
}

TEST(HuntGenerator, AConstantOfThePortKeepsItsValue) {
  HuntTarget target = target_of(Module::rate_unit, "px4-v1.16.0");
  target.lacks.words = {"MC_ROLLRATE_P=0.2"};
  target.lacks.constants = {{"MC_ROLLRATE_P", 0.2F}};
  target.lacks.features = only(Feature::parameter_changes);
  for (const HuntInputs& inputs : trials_of(target, 50)) {
    std::vector<float> values;
    for (const ParameterChange& change : inputs.parameters) {
      if (change.name == "MC_ROLLRATE_P") values.push_back(change.value);
    }
    EXPECT_THAT(values, testing::ElementsAre(0.2F));
  }
}

}  // namespace
}  // namespace attest
