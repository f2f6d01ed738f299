#include "harness/diagnosis/diagnose.hpp"

#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/builtin.hpp"
#include "harness/port/fault_port.hpp"
#include "tests/harness/verify/small_suite.hpp"

namespace attest {
namespace {

// Vectors of a few cases for a port with these faults.
std::vector<VectorSimilarity> vectors(const char* faults) {
  SmallSuite suite;
  suite.add_unblessed("level", "");
  suite.add_unblessed("tilt",
                      "[control_state]\nq = { tilt_deg = { signal = \"ramp\", from = 0, to = 60, "
                      "end_ticks = 29 }, azimuth_deg = 30 }\n");
  suite.add_unblessed("yaw",
                      "[vehicle_attitude_setpoint]\nq_d = { tilt_deg = 40, yaw_deg = 25 }\n");
  suite.add_unblessed("thrust",
                      "[parameters]\nMC_TPA_BREAK = 0.3\n[control_state]\nroll_rate = 0.3\n"
                      "[vehicle_attitude_setpoint]\nthrust = 0.8\n");
  std::vector<VectorSimilarity> all;
  for (std::size_t i = 0; i < 4; ++i) {
    Trace law = stimulate(suite[i], Rate::hz(250));
    Trace got = law;
    const auto reference = open_builtin();
    drive(*reference->create("px4-v1.5.5"), law);
    const auto port = open_fault(faults);
    drive(*(*port)->create("px4-v1.5.5"), got);
    all.push_back(
        similarity(outputs_of(got), outputs_of(law), answers_of_faults(law, {"px4-v1.5.5"})));
  }
  return all;
}

TEST(Diagnose, WhatAgreesIsNotDiagnosed) {
  // Equivalent to the law.
  EXPECT_FALSE(diagnose(vectors("limits-exchanged")));
}

TEST(Diagnose, NamesTheFaultFirst) {
  const auto diagnosis = diagnose(vectors("yaw-weight-dropped"));
  ASSERT_TRUE(diagnosis);
  ASSERT_FALSE(diagnosis->suspects.empty());
  const Suspect& first = diagnosis->suspects.front();
  EXPECT_EQ(first.fault->id, "yaw-weight-dropped");
  EXPECT_EQ(first.matched, first.ticks);
  EXPECT_EQ(first.explained, diagnosis->failing);
  EXPECT_EQ(diagnosis->stage, faults::Stage::yaw);
}

TEST(Diagnose, NamesBothOfTwo) {
  const auto diagnosis = diagnose(vectors("yaw-weight-dropped+tpa-missing"));
  ASSERT_TRUE(diagnosis);
  ASSERT_GE(diagnosis->suspects.size(), 2u);
  std::string named;
  for (const Suspect& suspect : diagnosis->suspects) named += std::string(suspect.fault->id) + " ";
  EXPECT_NE(named.find("yaw-weight-dropped"), std::string::npos) << named;
  EXPECT_NE(named.find("tpa-missing"), std::string::npos) << named;
}

// A port that matches no fault of the catalogue still deviates somewhere.
TEST(Diagnose, WithoutASuspectTheStageIsWhereDeviationsLie) {
  std::vector<VectorSimilarity> all = vectors("yaw-weight-dropped");
  for (VectorSimilarity& vector : all) {
    for (Similarity& one : vector.similarities) {
      if (one.matched == vector.ticks && vector.deviates) --one.matched;
    }
  }
  const auto diagnosis = diagnose(all);
  ASSERT_TRUE(diagnosis);
  EXPECT_TRUE(diagnosis->suspects.empty());
  EXPECT_EQ(diagnosis->stage, faults::Stage::yaw);
  EXPECT_EQ(diagnosis->jaccard_index, 1);
}

}  // namespace
}  // namespace attest
