#include "harness/diagnosis/diagnose.hpp"

#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/builtin.hpp"
#include "harness/port/fault_port.hpp"
#include "tests/harness/verify/small_suite.hpp"

namespace attest {
namespace {

// A port with these faults, on a few cases.
class Diagnose : public testing::Test {
 protected:
  Diagnose() {
    suite_.add_unblessed("level", "");
    suite_.add_unblessed(
        "tilt",
        "[control_state]\nq = { tilt_deg = { signal = \"ramp\", from = 0, to = 60, "
        "end_ticks = 29 }, azimuth_deg = 30 }\n");
    suite_.add_unblessed("yaw",
                         "[vehicle_attitude_setpoint]\nq_d = { tilt_deg = 40, yaw_deg = 25 }\n");
    suite_.add_unblessed("thrust",
                         "[parameters]\nMC_TPA_BREAK = 0.3\n[control_state]\nroll_rate = 0.3\n"
                         "[vehicle_attitude_setpoint]\nthrust = 0.8\n");
  }

  std::optional<Diagnosis> diagnosed(const char* faults) const {
    Evidence evidence;
    evidence.failing = 4;
    evidence.compare = [&](const auto& vectors, const std::vector<Hypothesis>& hypotheses) {
      std::vector<VectorSimilarity> all;
      for (const std::size_t i : vectors) {
        Trace law = stimulate(suite_[i], Rate::hz(250));
        Trace got = law;
        drive(*open_builtin()->create("px4-v1.5.5"), law);
        drive(*(*open_fault(faults))->create("px4-v1.5.5"), got);
        all.push_back(similarity(outputs_of(got), outputs_of(law),
                                 answers_of(hypotheses, law, {"px4-v1.5.5"})));
      }
      return all;
    };
    return diagnose(evidence);
  }

  SmallSuite suite_;
};

TEST_F(Diagnose, WhatAgreesIsNotDiagnosed) {
  // Equivalent to the law.
  EXPECT_FALSE(diagnosed("limits-exchanged"));
}

TEST_F(Diagnose, NamesTheFault) {
  const auto diagnosis = diagnosed("yaw-weight-dropped");
  ASSERT_TRUE(diagnosis);
  ASSERT_EQ(diagnosis->suspects.size(), 1u);
  EXPECT_EQ(diagnosis->suspects.front().fault->id, "yaw-weight-dropped");
  EXPECT_EQ(diagnosis->unexplained, 0u);
  EXPECT_EQ(diagnosis->stage, faults::Stage::yaw);
}

TEST_F(Diagnose, NamesAllThatAct) {
  for (const char* const faults :
       {"yaw-weight-dropped+tpa-missing", "yaw-weight-dropped+tpa-missing+tilt-as-sine"}) {
    const auto diagnosis = diagnosed(faults);
    ASSERT_TRUE(diagnosis);
    EXPECT_EQ(diagnosis->unexplained, 0u) << faults;
    for (const Suspect& suspect : diagnosis->suspects) {
      EXPECT_NE(std::string_view(faults).find(suspect.fault->id), std::string::npos)
          << suspect.fault->id;
    }
  }
}

// Both change the yaw error of every vector with a tilt, so neither has the port's values alone.
TEST_F(Diagnose, NamesAPairOfWhichNeitherMatchesAlone) {
  const auto diagnosis = diagnosed("tilt-as-sine+yaw-before-tilt");
  ASSERT_TRUE(diagnosis);
  EXPECT_EQ(diagnosis->suspects.size(), 2u);
  EXPECT_EQ(diagnosis->unexplained, 0u);
}

}  // namespace
}  // namespace attest
