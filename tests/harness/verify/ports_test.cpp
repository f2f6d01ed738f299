// Each port of tests/ports gets the verdict that the comment at its top states.
#include <cerrno>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/harness/verify/small_suite.hpp"

namespace attest {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t fault_step = 20;  // of tests/ports/wrapper.h

class PortsTest : public testing::Test {
 protected:
  void SetUp() override { suite_.add_three(); }

  JobResults<VectorResult> run(const std::string& port) {
    return suite_.run(host_of(port == "builtin" ? port : test_port(port)));
  }

  // The results of the six tasks, all of one verdict.
  std::vector<VectorResult> all_are(const std::string& port, Verdict verdict) {
    const auto outcome = run(port);
    EXPECT_THAT(outcome.errors, IsEmpty());
    EXPECT_EQ(outcome.results.size(), 6u);
    for (const VectorResult& result : outcome.results) {
      EXPECT_EQ(name_of(result.verdict), name_of(verdict)) << result.id() << result.reason;
    }
    return outcome.results;
  }

  SmallSuite suite_;
};

TEST_F(PortsTest, TheReferencePasses) {
  const auto results = all_are("builtin", Verdict::pass);
  for (const VectorResult& result : results) EXPECT_EQ(result.ticks, 30u);
}

TEST_F(PortsTest, RightPortsPass) {
  all_are("global_state", Verdict::pass);
  all_are("sets_ftz", Verdict::pass);
}

TEST_F(PortsTest, AWordyPortIsNotHeard) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  all_are("prints", Verdict::pass);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// With a sanitizer the port's process prints a report and exits.
TEST_F(PortsTest, ACrashHasTheNameOfItsSignalAndTheRestStillRuns) {
  for (const VectorResult& result : all_are("crash", Verdict::crash)) {
    EXPECT_THAT(result.reason, AnyOf(HasSubstr("was killed by signal 11 (Segmentation fault)"),
                                     HasSubstr("exited with status")));
  }
}

TEST_F(PortsTest, AnExitIsACrash) {
  for (const VectorResult& result : all_are("exits", Verdict::crash)) {
    EXPECT_THAT(result.reason, HasSubstr("the port's process exited with status"));
  }
}

TEST_F(PortsTest, AHangIsATimeoutOnceACase) {
  HostOptions host = host_of(test_port("hang"));
  host.timeout_s = 0.3;
  const auto outcome = suite_.run(host, 3);
  ASSERT_EQ(outcome.results.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(outcome.results[i].verdict, Verdict::timeout);
    EXPECT_EQ(outcome.results[i].reason,
              i % 2 == 0 ? "no answer within 0.3 s of CPU time in step() at tick 20"
                         : "not run: the port had timed out before");
  }
}

TEST_F(PortsTest, AHangInAnyFunctionIsATimeout) {
  suite_.add("rolls", "[parameters]\nMC_ROLL_P = 7.0\n");
  for (const char* port :
       {"hangs_in_load", "hangs_in_create", "hangs_in_set_parameter", "hangs_in_destroy"}) {
    HostOptions host = host_of(test_port(port));
    host.timeout_s = 0.3;
    const auto outcome = suite_.run(host);
    EXPECT_THAT(outcome.errors, IsEmpty());
    ASSERT_EQ(outcome.results.size(), 8u);
    EXPECT_EQ(outcome.results[6].verdict, Verdict::timeout) << port;
  }
}

TEST_F(PortsTest, NanWhereANumberBelongsIsNonFinite) {
  for (const VectorResult& result : all_are("non_finite", Verdict::non_finite)) {
    ASSERT_TRUE(result.first);
    EXPECT_EQ(result.first->tick, fault_step);
    EXPECT_EQ(channels()[result.first->channel].name, "out/actuator_controls_0.control[1]");
  }
}

TEST_F(PortsTest, ASilentPortFailsAtTheFirstPublication) {
  for (const VectorResult& result : all_are("silent", Verdict::fail)) {
    ASSERT_TRUE(result.first);
    EXPECT_EQ(result.first->tick, 0u);
    EXPECT_EQ(channels()[result.first->channel].name, "out/vehicle_rates_setpoint.published");
    EXPECT_EQ(result.deviating_ticks, 30u);
  }
}

TEST_F(PortsTest, AStepThatFailsSaysWhere) {
  for (const VectorResult& result : all_are("step_fails", Verdict::fail)) {
    EXPECT_EQ(result.reason,
              "step at tick 20 returned ATTEST_FAILED; it last printed: no solution of the tilt");
    EXPECT_FALSE(result.first);
  }
}

TEST_F(PortsTest, UnsupportedAndRefusedAreNoFailures) {
  all_are("unsupported_step", Verdict::unsupported);
  for (const VectorResult& result : all_are("refuses_profile", Verdict::skip)) {
    EXPECT_EQ(result.reason, "the port does not support profile px4-v1.5.5");
  }
}

TEST_F(PortsTest, WritingBehindTheOutputsBreaksTheProtocol) {
  for (const VectorResult& result : all_are("writes_wild", Verdict::protocol)) {
    EXPECT_THAT(result.reason, HasSubstr("step wrote outside its outputs at tick 20"));
  }
}

TEST_F(PortsTest, AFlippedSignFailsWhereItShows) {
  const auto outcome = run("sign_flip");
  ASSERT_EQ(outcome.results.size(), 6u);
  for (const VectorResult& result : outcome.results) {
    if (result.name != "pitch") {
      EXPECT_EQ(result.verdict, Verdict::pass) << result.id();
      continue;
    }
    EXPECT_EQ(result.verdict, Verdict::fail);
    ASSERT_TRUE(result.first);
    EXPECT_EQ(result.first->tick, 3u);
    EXPECT_EQ(channels()[result.first->channel].name, "out/actuator_controls_0.control[1]");
    EXPECT_EQ(result.first->got > 0, result.first->want < 0);
  }
}

std::vector<std::string> without_last_words(std::vector<std::string> lines) {
  for (std::string& line : lines) line = line.substr(0, line.find("; it last printed"));
  return lines;
}

TEST_F(PortsTest, AnyNumberOfJobsGivesTheSame) {
  for (const char* port : {"crash", "sign_flip", "non_finite", "prints", "unsupported_step"}) {
    std::set<std::vector<std::string>> outcomes;
    for (const int jobs : {1, 2, 4, 50}) {
      // With a sanitizer the last words have a process id.
      outcomes.insert(without_last_words(lines_of(suite_.run(host_of(test_port(port)), jobs))));
    }
    EXPECT_EQ(outcomes.size(), 1u) << port;
  }
}

TEST_F(PortsTest, InProcessGivesTheSame) {
  for (const char* port : {"sign_flip", "non_finite", "step_fails", "global_state"}) {
    HostOptions host = host_of(test_port(port));
    const auto apart = without_last_words(lines_of(suite_.run(host)));
    host.in_process = true;  // what the port prints goes to the terminal
    EXPECT_EQ(lines_of(suite_.run(host)), apart) << port;
  }
}

// A processor in flush-to-zero mode makes 0 of this.
bool has_denormals() {
  volatile float tiny = 1e-40f;
  volatile float half = 0.5f;
  return tiny * half != 0.0f;
}

TEST_F(PortsTest, AFloatingPointModeOfThePortStaysItsOwn) {
  // These inputs are denormal. They are generated for the port and compared with the golden to the
  // bit.
  suite_.add("tiny", "[control_state]\nroll_rate = 1e-40\n");
  for (const bool in_process : {false, true}) {
    HostOptions host = host_of(test_port("sets_ftz"));
    host.in_process = in_process;
    const auto outcome = suite_.run(host);
    EXPECT_THAT(outcome.errors, IsEmpty());
    EXPECT_EQ(outcome.results.size(), 8u);
    for (const VectorResult& result : outcome.results) {
      EXPECT_EQ(result.verdict, Verdict::pass) << result.id() << result.reason;
    }
    EXPECT_TRUE(has_denormals());
  }
}

TEST_F(PortsTest, NoChildIsLeft) {
  run("crash");
  run("exits");
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace attest
