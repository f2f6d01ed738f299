// Programs that are missing, fail, hang or print without end.
#include "harness/process/program.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace attest {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

std::vector<std::string> shell(const std::string& script) { return {"sh", "-c", script}; }

const ProgramLimits generous{60, [] { return false; }};

TEST(Program, GivesItsOutput) {
  EXPECT_EQ(output_of(shell("echo one; echo two >&2"), generous), "one\n");
  EXPECT_FALSE(output_of(shell("echo one; exit 3"), generous));
  EXPECT_FALSE(output_of({"no-such-program-of-attest"}, generous));
}

TEST(Program, IsInstalledWhereAFileOfPathCanBeExecuted) {
  EXPECT_TRUE(is_installed("sh"));
  EXPECT_FALSE(is_installed("no-such-program-of-attest"));
  EXPECT_FALSE(is_installed("."));  // a folder
}

TEST(Program, HasNoInput) { EXPECT_EQ(output_of({"cat"}, generous), ""); }

TEST(Program, ThatNeverEndsIsStopped) {
  const auto begin = Clock::now();
  EXPECT_FALSE(output_of(shell("trap '' TERM; echo one; while :; do sleep 1; done"), {0.2}));
  EXPECT_FALSE(output_of(shell("exec >&-; while :; do sleep 1; done"), {0.2}));
  EXPECT_LT(Clock::now() - begin, 30s);
}

TEST(Program, ThatNeverStopsPrintingIsStopped) {
  const auto begin = Clock::now();
  EXPECT_FALSE(output_of({"yes"}, generous));
  EXPECT_LT(Clock::now() - begin, 50s);
}

TEST(Program, IsNotWaitedForWhenItsOutputIsNotNeededAnyMore) {
  const auto begin = Clock::now();
  EXPECT_FALSE(output_of({"sleep", "1000"}, {1000, [] { return true; }}));
  EXPECT_LT(Clock::now() - begin, 30s);
}

TEST(Program, ItsOutputIsCompleteThoughWhatItStartedHoldsThePipe) {
  const auto begin = Clock::now();
  EXPECT_EQ(output_of(shell("sleep 1000 & echo one"), generous), "one\n");
  EXPECT_LT(Clock::now() - begin, 50s);
}

TEST(Program, ThatCannotBeExecutedSaysSoByItsStatus) {
  auto program = start_program({"no-such-program-of-attest"});
  ASSERT_TRUE(program);
  EXPECT_EQ(program->end(60).to_string(), "exited with status 127");
}

}  // namespace
}  // namespace attest
