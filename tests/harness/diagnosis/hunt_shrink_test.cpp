#include "harness/diagnosis/hunt_shrink.hpp"

#include <gtest/gtest.h>

#include "harness/host/in_process_host.hpp"
#include "harness/port/fault_port.hpp"
#include "tests/harness/diagnosis/hunted.hpp"

namespace attest {
namespace {

const char* const shrunk_port = "cascade-d-reversed";

HuntTarget shrunk_target() {
  HuntTarget target;
  target.subject = {"px4-v1.16.0", Module::rate_unit};
  return target;
}

struct Failing {
  HuntInputs inputs;
  HuntTrial trial;
};

// The next failing trial from `number` on, which is then the number after it.
Failing next_failing(std::uint64_t& number) {
  InProcessHost host(*open_fault(shrunk_port));
  for (;;) {
    const HuntInputs inputs = make_trial(shrunk_target(), 1, number++, {});
    auto trial = judge_trial(inputs, shrunk_target(), host);
    EXPECT_TRUE(trial);
    if (trial && trial->failure) return {inputs, *trial};
  }
}

TEST(HuntShrink, ASmallerTrialFailsInTheSameWay) {
  std::uint64_t number = 0;
  for (int i = 0; i < 5; ++i) {
    const auto [inputs, trial] = next_failing(number);
    const auto shrunk = shrink(shrunk_target(), inputs, *trial.failure, fault_host(shrunk_port));
    ASSERT_TRUE(shrunk) << shrunk.error().to_string();
    EXPECT_LT(shrunk->inputs.steps(), 8u) << "trial " << number - 1;
    EXPECT_LE(shrunk->inputs.ticks.size(), inputs.ticks.size());
    EXPECT_LE(shrunk->inputs.parameters.size(), 1u) << "trial " << number - 1;
    EXPECT_TRUE(fail_the_same_way(shrunk->failure, *trial.failure));
    InProcessHost host(*open_fault(shrunk_port));
    const auto again = judge_trial(shrunk->inputs, shrunk_target(), host);
    ASSERT_TRUE(again && again->failure) << "trial " << number - 1;
    EXPECT_TRUE(fail_the_same_way(*again->failure, shrunk->failure));
  }
}

TEST(HuntShrink, FailuresDifferInTheVerdictAndTheFirstOutput) {
  std::uint64_t number = 0;
  VectorResult one = *next_failing(number).trial.failure;
  VectorResult other = one;
  EXPECT_TRUE(fail_the_same_way(one, other));
  other.first->tick += 3;
  EXPECT_TRUE(fail_the_same_way(one, other));
  ++other.first->channel;
  EXPECT_FALSE(fail_the_same_way(one, other));
  other.first.reset();
  EXPECT_FALSE(fail_the_same_way(one, other));
  one.first.reset();
  EXPECT_TRUE(fail_the_same_way(one, other));
  other.verdict = Verdict::crash;
  EXPECT_FALSE(fail_the_same_way(one, other));
}

TEST(HuntShrink, ATimeoutIsNotShrunk) {
  const auto hangs = [](const ModuleUnderTest&, Trace&) {
    return PortFault{PortFault::Kind::timeout, 0, "no answer"};
  };
  int starts = 0;
  HostOptions host = changed_host(hangs);
  host.start = [&, start = host.start](const HostOptions& options, const Course& course) {
    ++starts;
    return start(options, course);
  };
  const HuntInputs inputs = make_trial(shrunk_target(), 1, 0, {});
  VectorResult failed;
  failed.verdict = Verdict::timeout;
  const auto shrunk = shrink(shrunk_target(), inputs, failed, host);
  ASSERT_TRUE(shrunk);
  EXPECT_EQ(shrunk->inputs.ticks.size(), inputs.ticks.size());
  EXPECT_EQ(starts, 0);
}

}  // namespace
}  // namespace attest
