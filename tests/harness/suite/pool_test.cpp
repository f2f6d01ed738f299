// The worker processes with batches made for the test: what a port could do, without a port.
#include <algorithm>
#include <cstdlib>
#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/suite/message.hpp"
#include "harness/suite/worker.hpp"
#include "tests/harness/suite/small_suite.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Task = std::function<Verdict()>;

class FakeBatch final : public Batch {
 public:
  FakeBatch(std::string name, std::vector<Task> tasks)
      : name_(std::move(name)), tasks_(std::move(tasks)) {}

  std::size_t size() const override { return tasks_.size(); }
  CaseResult identity(std::size_t i) const override {
    CaseResult result;
    result.profile = "px4-v1.5.5";
    result.group = "tests";
    result.name = name_;
    result.rate = Rate::hz(static_cast<std::int64_t>(i) + 1);
    return result;
  }
  Result<CaseResult> evaluate(std::size_t i, Port&) override {
    CaseResult result = identity(i);
    result.verdict = tasks_[i]();
    return result;
  }

 private:
  std::string name_;
  std::vector<Task> tasks_;
};

// One task of so many slow parts.
class PartsBatch final : public Batch {
 public:
  explicit PartsBatch(int parts) : parts_(parts) {}

  std::size_t size() const override { return 1; }
  CaseResult identity(std::size_t) const override { return {}; }
  std::size_t most_parts() const override { return static_cast<std::size_t>(parts_); }
  Result<CaseResult> evaluate(std::size_t i, Port&) override {
    for (int part = 0; part < parts_; ++part) {
      begin_part();
      ::usleep(50'000);
    }
    return identity(i);
  }

 private:
  int parts_;
};

class BrokenBatch final : public Batch {
 public:
  std::size_t size() const override { return 1; }
  CaseResult identity(std::size_t) const override { return {}; }
  Result<CaseResult> evaluate(std::size_t, Port&) override { return fail("no golden"); }
};

Verdict pass() { return Verdict::pass; }
Verdict failing() { return Verdict::fail; }
Verdict aborts() { std::abort(); }
Verdict slow_pass() {
  ::usleep(50'000);
  return Verdict::pass;
}

Verdict hangs() {
  while (true) ::pause();
}

// As a library does that makes itself a daemon.
Verdict closes_everything_and_hangs() {
  for (int descriptor = 3; descriptor < 1024; ++descriptor) ::close(descriptor);
  return hangs();
}

// As a port does that looks for the pipe of its worker.
Task forges(const std::string& lines) {
  return [lines] {
    for (int descriptor = 3; descriptor < 1024; ++descriptor) {
      if (::write(descriptor, lines.data(), lines.size()) < 0) continue;
    }
    return Verdict::fail;
  };
}

// The answer of task i of case_0.
std::string forged_pass(std::size_t i) {
  CaseResult result = FakeBatch("case_0", {}).identity(i);
  return encode(result) + "\n";
}

Batches batches_of(const std::vector<std::vector<Task>>& all) {
  Batches batches;
  for (std::size_t i = 0; i < all.size(); ++i) {
    batches.push_back(std::make_unique<FakeBatch>(fmt::format("case_{}", i), all[i]));
  }
  return batches;
}

WorkerOptions with_jobs(int jobs) {
  WorkerOptions options;
  options.port = "builtin";
  options.jobs = jobs;
  return options;
}

std::vector<std::string> verdicts(const WorkerOutcome& outcome) {
  std::vector<std::string> list;
  for (const CaseResult& result : outcome.results) {
    list.push_back(
        fmt::format("{}@{} {}", result.name, result.rate.to_string(), name_of(result.verdict)));
  }
  return list;
}

TEST(Pool, ResultsAreInOrderWhateverFinishesFirst) {
  const auto batches = batches_of({{slow_pass, pass}, {pass}, {slow_pass}, {pass}});
  for (const int jobs : {1, 4}) {
    EXPECT_THAT(verdicts(run_batches(batches, with_jobs(jobs))),
                ElementsAre("case_0@1 pass", "case_0@2 pass", "case_1@1 pass", "case_2@1 pass",
                            "case_3@1 pass"));
  }
}

TEST(Pool, AfterACrashTheRestOfTheBatchStillRuns) {
  const auto outcome =
      run_batches(batches_of({{pass, aborts, pass, aborts}, {pass}}), with_jobs(1));
  EXPECT_THAT(verdicts(outcome), ElementsAre("case_0@1 pass", "case_0@2 crash", "case_0@3 pass",
                                             "case_0@4 crash", "case_1@1 pass"));
  EXPECT_EQ(outcome.results[1].reason, "the port's process was killed by signal 6 (Aborted)");
}

TEST(Pool, ACrashHasTheLastWordsOfThePort) {
  const auto batches = batches_of({{[]() -> Verdict {
    fputs("first line\nassertion failed\n\n", stderr);
    std::abort();
  }}});
  EXPECT_THAT(run_batches(batches, with_jobs(1)).results[0].reason,
              HasSubstr("; it last printed: assertion failed"));
}

TEST(Pool, AfterATimeoutTheRestOfTheBatchIsNotTried) {
  WorkerOptions options = with_jobs(1);
  options.timeout_s = 0.3;
  const auto outcome = run_batches(batches_of({{hangs, pass}, {pass}}), options);
  EXPECT_THAT(verdicts(outcome),
              ElementsAre("case_0@1 timeout", "case_0@2 timeout", "case_1@1 pass"));
}

// Its end is not to be waited for.
TEST(Pool, AProcessThatClosesItsPipeAndLivesOnIsACrash) {
  const auto outcome = run_batches(batches_of({{closes_everything_and_hangs, pass}}), with_jobs(1));
  EXPECT_THAT(verdicts(outcome), ElementsAre("case_0@1 crash", "case_0@2 pass"));
}

TEST(Pool, WhatIsNoAnswerToTheTaskIsAForgery) {
  const std::string lines[] = {
      "{\"begin\": 0}\n",  // again
      "{\"begin\": 1}\n",  // of another task
      "{\"done\": true}\n",
      "no message\n",
      forged_pass(1),
      forged_pass(0),  // and then comes the worker's own
      FakeBatch("case_1", {}).identity(0).name + "\n",
  };
  for (const std::string& line : lines) {
    const auto outcome = run_batches(batches_of({{forges(line)}, {pass}}), with_jobs(1));
    EXPECT_THAT(verdicts(outcome), ElementsAre("case_0@1 protocol", "case_1@1 pass")) << line;
    EXPECT_EQ(outcome.results[0].reason,
              "the port wrote on the pipe on which attest's worker answers");
  }
}

TEST(Pool, AForgeryCastsDoubtOnWhatTheProcessAnsweredBefore) {
  const auto outcome =
      run_batches(batches_of({{pass, forges("{\"begin\": 7}\n"), pass}}), with_jobs(1));
  EXPECT_THAT(verdicts(outcome),
              ElementsAre("case_0@1 protocol", "case_0@2 protocol", "case_0@3 pass"));
}

TEST(Pool, APortThatAnswersItselfAndEndsIsNotBelieved) {
  const Task answers_and_ends = [] {
    forges(forged_pass(0))();
    ::_exit(0);
    return Verdict::pass;
  };
  const auto outcome = run_batches(batches_of({{answers_and_ends}}), with_jobs(1));
  EXPECT_THAT(verdicts(outcome), ElementsAre("case_0@1 protocol"));
}

// A task without parts has one limit, whatever the port writes.
TEST(Pool, AMessageDoesNotRenewTheTimeLimit) {
  WorkerOptions options = with_jobs(1);
  options.timeout_s = 0.3;
  const Task goes_on_beginning = [] {
    while (true) {
      forges("{\"begin\": 0}\n")();
      ::usleep(50'000);
    }
    return Verdict::pass;
  };
  const auto outcome = run_batches(batches_of({{goes_on_beginning}}), options);
  EXPECT_THAT(verdicts(outcome), ElementsAre("case_0@1 protocol"));
}

TEST(Pool, EachTaskHasTheWholeTimeLimit) {
  WorkerOptions options = with_jobs(1);
  options.timeout_s = 2;
  const std::vector<Task> tasks(50, slow_pass);  // 2.5 s in all
  const auto outcome = run_batches(batches_of({tasks}), options);
  EXPECT_EQ(std::count_if(outcome.results.begin(), outcome.results.end(),
                          [](const CaseResult& r) { return r.verdict == Verdict::pass; }),
            50);
}

TEST(Pool, EachPartOfATaskHasTheWholeTimeLimit) {
  Batches batches;
  batches.push_back(std::make_unique<PartsBatch>(50));  // 2.5 s in all
  WorkerOptions options = with_jobs(1);
  options.timeout_s = 2;
  const auto outcome = run_batches(batches, options);
  ASSERT_EQ(outcome.results.size(), 1u);
  EXPECT_EQ(outcome.results[0].verdict, Verdict::pass) << outcome.results[0].reason;
}

// It would hang in each process.
TEST(Pool, APortThatHangsWhenItIsLoadedIsTriedOnce) {
  WorkerOptions options = with_jobs(1);
  options.timeout_s = 0.3;
  options.port = test_port("hangs_in_load");
  const auto outcome = run_batches(batches_of({{pass}, {pass, pass}}), options);
  ASSERT_EQ(outcome.results.size(), 3u);
  EXPECT_THAT(outcome.errors, IsEmpty());
  EXPECT_EQ(outcome.results[0].reason, "no answer within 0.3 s, when it was loaded");
  for (const CaseResult& result : outcome.results) EXPECT_EQ(result.verdict, Verdict::timeout);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(outcome.results[i].reason, "not run: the port had timed out when it was loaded");
  }
}

TEST(Pool, FailFastEndsWithTheFirstBatchThatFailsInTheirOrder) {
  const auto batches = batches_of({{slow_pass}, {slow_pass, failing, pass}, {failing}, {pass}});
  for (const bool in_process : {false, true}) {
    for (const int jobs : {1, 2, 4}) {
      WorkerOptions options = with_jobs(jobs);
      options.fail_fast = true;
      options.in_process = in_process;
      const auto outcome = run_batches(batches, options);
      EXPECT_THAT(verdicts(outcome),
                  ElementsAre("case_0@1 pass", "case_1@1 pass", "case_1@2 fail", "case_1@3 pass"));
      EXPECT_TRUE(outcome.stopped_early);
    }
  }
}

TEST(Pool, AFailureInTheLastBatchStopsNothing) {
  const auto batches = batches_of({{pass}, {failing}});
  for (const bool in_process : {false, true}) {
    WorkerOptions options = with_jobs(2);
    options.fail_fast = true;
    options.in_process = in_process;
    EXPECT_FALSE(run_batches(batches, options).stopped_early);
  }
}

TEST(Pool, ErrorsOfTheEnvironmentAreNoVerdicts) {
  for (const bool in_process : {false, true}) {
    Batches batches = batches_of({{pass}});
    batches.push_back(std::make_unique<BrokenBatch>());
    WorkerOptions options = with_jobs(2);
    options.in_process = in_process;
    const auto outcome = run_batches(batches, options);
    EXPECT_THAT(verdicts(outcome), ElementsAre("case_0@1 pass"));
    ASSERT_EQ(outcome.errors.size(), 1u);
    EXPECT_EQ(outcome.errors[0].message, "no golden");
  }
}

TEST(Pool, APortThatCannotBeOpenedIsAnError) {
  for (const bool in_process : {false, true}) {
    WorkerOptions options = with_jobs(1);
    options.port = test_port("no_symbol");
    options.in_process = in_process;
    const auto outcome = run_batches(batches_of({{pass, pass}}), options);
    EXPECT_THAT(outcome.results, IsEmpty());
    ASSERT_EQ(outcome.errors.size(), 1u);
    EXPECT_THAT(outcome.errors[0].message, HasSubstr("exports no attest_unit_v1()"));
  }
}

TEST(Pool, EveryResultIsToldOnce) {
  for (const bool in_process : {false, true}) {
    std::vector<std::string> told;
    WorkerOptions options = with_jobs(3);
    options.in_process = in_process;
    options.on_result = [&](const CaseResult& result) { told.push_back(result.id()); };
    const auto outcome = run_batches(batches_of({{pass, failing}, {pass}, {pass}}), options);
    std::sort(told.begin(), told.end());
    std::vector<std::string> ids;
    for (const CaseResult& result : outcome.results) ids.push_back(result.id());
    EXPECT_EQ(told, ids);
  }
}

TEST(Pool, StopsWhenItIsTold) {
  for (const bool in_process : {false, true}) {
    int results = 0;
    WorkerOptions options = with_jobs(1);
    options.in_process = in_process;
    options.on_result = [&](const CaseResult&) { ++results; };
    options.stop = [&] { return results > 0; };
    run_batches(batches_of({{pass}, {pass}, {pass}}), options);
    EXPECT_EQ(results, 1);
  }
}

TEST(Pool, NothingToDoIsDone) {
  EXPECT_THAT(run_batches({}, with_jobs(2)).results, IsEmpty());
  // Not even the lack of workers leaves out a batch.
  EXPECT_EQ(run_batches(batches_of({{pass}}), with_jobs(0)).results.size(), 1u);
}

}  // namespace
}  // namespace attest
