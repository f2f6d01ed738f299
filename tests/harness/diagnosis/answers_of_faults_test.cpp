// The outputs of the catalogue's faults for the inputs of a vector.
#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/diagnosis/similarity.hpp"
#include "harness/port/builtin.hpp"
#include "harness/port/fault_port.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::IsEmpty;
using testing::Lt;
using testing::SizeIs;

const ModuleUnderTest subject{"px4-v1.5.5"};

// A vector on which a dropped yaw weight and a missing attenuation change the outputs.
Trace given() {
  return stimulate(
      case_of("[parameters]\nMC_TPA_BREAK = 0.3\n[control_state]\nroll_rate = 0.3\n"
              "[vehicle_attitude_setpoint]\nq_d = { tilt_deg = 40, yaw_deg = 25 }\nthrust = 0.8\n"),
      Rate::hz(250));
}

Outputs answers(Port& port) {
  Trace trace = given();
  EXPECT_FALSE(drive(port, subject, trace));
  return outputs_of(trace);
}

const Outputs& of(const char* id, const FaultAnswers& faults) {
  const auto all = faults::catalogue();
  const auto found = std::find(all.begin(), all.end(), faults::find_fault(id));
  return faults.distinct.at(faults.of_fault.at(static_cast<std::size_t>(found - all.begin())));
}

bool are_equal(const Outputs& a, const Outputs& b) {
  return !a.empty() && a.size() == b.size() && distinct_similarity(a, b, {}).deviating == 0;
}

TEST(AnswersOfFaults, AreThoseOfEachFault) {
  const FaultAnswers faults = answers_of(each_fault(), given(), subject);
  ASSERT_THAT(faults.of_fault, SizeIs(faults::catalogue().size()));
  const Outputs law = answers(*open_builtin());
  for (const char* const id : {"yaw-weight-dropped", "tpa-missing", "outputs-late"}) {
    EXPECT_TRUE(are_equal(of(id, faults), answers(**open_fault(id)))) << id;
    EXPECT_FALSE(are_equal(of(id, faults), law)) << id;
  }
  EXPECT_TRUE(are_equal(of("limits-exchanged", faults), law))
      << "no input distinguishes it from the law";
}

// A worker computes those of many vectors.
TEST(AnswersOfFaults, DoNotDependOnTheVectorBefore) {
  const FaultAnswers first = answers_of(each_fault(), given(), subject);
  answers_of(each_fault(), stimulate(case_of("[control_state]\nroll_rate = -0.7\n"), Rate::hz(250)),
             subject);
  const FaultAnswers second = answers_of(each_fault(), given(), subject);
  ASSERT_EQ(first.of_fault, second.of_fault);
  for (std::size_t i = 0; i < first.distinct.size(); ++i) {
    const Outputs &a = first.distinct[i], &b = second.distinct[i];
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Answer)), 0) << i;
  }
}

TEST(AnswersOfFaults, ThatAreTheSameAreKeptOnce) {
  const FaultAnswers faults = answers_of(each_fault(), given(), subject);
  EXPECT_THAT(faults.distinct, SizeIs(Lt(faults.of_fault.size())));
  for (std::size_t i = 0; i < faults.distinct.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Outputs &a = faults.distinct[i], &b = faults.distinct[j];
      const bool same =
          a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Answer)) == 0;
      EXPECT_FALSE(same) << i << ", " << j;
    }
  }
}

TEST(AnswersOfFaults, OutputsThatAreThereAlreadyDoNotMatter) {
  Trace answered = given();
  EXPECT_FALSE(drive(**open_fault("yaw-reversed"), subject, answered));
  const FaultAnswers faults = answers_of(each_fault(), answered, subject);
  EXPECT_TRUE(are_equal(of("tpa-missing", faults), answers(**open_fault("tpa-missing"))));
}

TEST(AnswersOfFaults, TogetherWithOthersAreThoseOfAll) {
  const FaultAnswers faults =
      answers_of(each_fault({faults::find_fault("tpa-missing")}), given(), subject);
  EXPECT_TRUE(are_equal(of("yaw-weight-dropped", faults),
                        answers(**open_fault("tpa-missing+yaw-weight-dropped"))));
  EXPECT_TRUE(are_equal(of("limits-exchanged", faults), answers(**open_fault("tpa-missing"))));
}

TEST(AnswersOfFaults, OfAnotherLawAreThoseOfTheLaw) {
  const FaultAnswers faults = answers_of(each_fault(), given(), subject);
  EXPECT_TRUE(are_equal(of("cascade-i-never", faults), answers(*open_builtin())));
  const std::vector<Hypothesis> law{{}};
  EXPECT_TRUE(
      are_equal(answers_of(law, given(), subject).distinct.front(), answers(*open_builtin())));
}

TEST(AnswersOfFaults, OfAProfileThatTheyDoNotDoAreEmpty) {
  const FaultAnswers faults = answers_of(each_fault(), given(), {"px4-v0"});
  EXPECT_THAT(of("tpa-missing", faults), IsEmpty());
  EXPECT_THAT(of("yaw-weight-dropped", faults), IsEmpty());
}

}  // namespace
}  // namespace attest
