#include "harness/golden/keyframes.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/golden/blessed.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

class Keyframes : public testing::Test {
 protected:
  Keyframes()
      : case_(
            case_of("rates_hz = [250]\nrates_why = \"one\"\n[control_state]\n"
                    "roll_rate = { signal = \"sine\", amplitude = 0.3, cycles = 2 }\n"
                    "q = { yaw_deg = { signal = \"ramp\", from = 0, to = 40, end_ticks = 9 } }\n")),
        whole_(answers_of_reference(case_)[0].trace),
        kept_(keyframes_of(whole_)) {
    kept_.source = "golden/250hz.csv";
    kept_.samples.erase(kept_.samples.begin() + 5);  // a tick that the reference has to fill in
  }

  Result<Trace> fill() const {
    return filled_in(stimulate(case_, Rate::hz(250)), kept_, subject_of(case_), true);
  }
  std::string error() const {
    const auto filled = fill();
    EXPECT_FALSE(filled);
    return filled ? "" : filled.error().to_string();
  }

  Case case_;
  Trace whole_;
  Trace kept_;
};

TEST_F(Keyframes, TheReferenceFillsInTheTicksThatWereNotKept) {
  const auto filled = fill();
  ASSERT_TRUE(filled) << filled.error().to_string();
  EXPECT_EQ(filled->samples.size(), whole_.samples.size());
  EXPECT_EQ(first_input_difference(*filled, whole_), std::nullopt);
  EXPECT_TRUE(compare(*filled, whole_, Tolerances(Level::exact)).agrees());
}

TEST_F(Keyframes, AnAnswerThatIsNotTheReferencesIsAnError) {
  kept_.samples[3].out.mc_att_ctrl_status.roll_rate_integ += 1e-7f;
  EXPECT_THAT(error(), HasSubstr("at timestamp 5012000 the reference of this build answers another "
                                 "out/mc_att_ctrl_status.roll_rate_integ"));
}

TEST_F(Keyframes, AnInputThatTheCaseDoesNotMakeIsAnError) {
  kept_.samples[2].in.control_state.roll_rate = 1;
  EXPECT_THAT(error(), HasSubstr("golden/250hz.csv: has ticks or inputs that the case does not"));
}

TEST_F(Keyframes, ATickThatTheCaseDoesNotMakeIsAnError) {
  kept_.samples.back().in.timestamp += 1;
  EXPECT_THAT(error(), HasSubstr("has ticks or inputs that the case does not make"));
}

Trace flown(std::size_t ticks) {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    Sample sample{};
    sample.in.timestamp = 1000 * (tick + 1);
    sample.in.updated = 1;
    trace.samples.push_back(sample);
  }
  trace.plant.resize(ticks);
  return trace;
}

std::vector<std::size_t> kept(const Trace& rows) {
  std::vector<std::size_t> ticks;
  for (const Sample& row : rows.samples) ticks.push_back(row.in.timestamp / 1000 - 1);
  return ticks;
}

TEST(KeyframesOf, KeepsTheFirstTheRegularAndTheLast) {
  const auto ticks = kept(keyframes_of(flown(1201)));
  EXPECT_THAT(ticks, testing::IsSupersetOf({0u, 1u, 2u, 3u, 100u, 200u, 1100u, 1200u}));
  EXPECT_EQ(ticks.size(), 4u + 12u);
  EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
}

TEST(KeyframesOf, KeepsTheExtremesOfEveryOutput) {
  Trace trace = flown(2401);
  trace.samples[777].out.actuator_controls_0.control[2] = -1;
  trace.samples[1234].out.mc_att_ctrl_status.yaw_rate_integ = 0.5f;
  EXPECT_THAT(kept(keyframes_of(trace)), testing::IsSupersetOf({777u, 1234u}));
}

TEST(KeyframesOf, NaNIsNoExtreme) {
  for (const std::size_t nan : {0u, 777u}) {
    Trace trace = flown(2401);
    trace.samples[nan].out.actuator_controls_0.control[2] = std::nanf("");
    trace.samples[778].out.actuator_controls_0.control[2] = 1;
    trace.samples[779].out.actuator_controls_0.control[2] = -1;
    const auto ticks = kept(keyframes_of(trace));
    EXPECT_THAT(ticks, testing::Not(testing::Contains(777u)));
    EXPECT_THAT(ticks, testing::IsSupersetOf({778u, 779u}));
  }
}

TEST(KeyframesOf, AShortFlightIsKeptWhole) {
  EXPECT_THAT(kept(keyframes_of(flown(3))), testing::ElementsAre(0u, 1u, 2u));
  EXPECT_THAT(kept(keyframes_of(flown(1))), testing::ElementsAre(0u));
}

// Any topic may have been updated between two rows.
TEST(KeyframesOf, SaysNothingOfWhatWasNew) {
  const Trace rows = keyframes_of(flown(30));
  EXPECT_EQ(rows.present & channels_of(Module::mc_att_control, "in/updated."), ChannelSet());
  EXPECT_EQ(rows.samples[0].in.updated, 0u);
  EXPECT_TRUE(rows.plant.empty());
}

}  // namespace
}  // namespace attest
