#include "harness/golden/keyframes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/golden/decimate.hpp"
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
        kept_(decimated(whole_)) {
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

}  // namespace
}  // namespace attest
