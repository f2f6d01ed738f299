// Jobs made for the test: what can happen to a worker, without a port.
#include "harness/process/job.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "harness/process/child.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {

template <>
struct Codec<std::string> {
  static std::string encode(const Result<std::string>& result) {
    return result ? "=" + *result : "!" + result.error().message;
  }
  static Result<std::string> decode(const std::string& text) {
    if (text.starts_with("!")) return fail(text.substr(1));
    return text.substr(1);
  }
};

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Task = std::function<Result<std::string>()>;

class FakeJob final : public Job<std::string> {
 public:
  FakeJob(std::vector<Task> tasks, bool opens) : tasks_(std::move(tasks)), opens_(opens) {}

  std::size_t size() const override { return tasks_.size(); }
  Result<void> begin_worker() override {
    worker_began_with = tasks_.size();
    return worker_begins();
  }
  bool ends_worker() const override { return tasks_.size() == ends_worker_after; }
  Result<void> open() override {
    if (!opens_) return fail("no golden");
    opened_ = true;
    done_since_open_ = 0;
    return {};
  }
  Result<std::string> run(std::size_t task) override {
    if (!opened_) return fail("not open");
    auto result = tasks_[task]();
    is_spent_ = result && *result == "spent";
    ++done_since_open_;
    if (result && *result == "counts") return fmt::format("task {}", done_since_open_);
    return result;
  }
  bool is_spent() const override { return is_spent_; }
  void close() override { opened_ = false; }

  // Both are the number of tasks of a job.
  static inline std::size_t worker_began_with = 0;
  static inline std::size_t ends_worker_after = 1000;
  static inline std::function<Result<void>()> worker_begins = [] { return Result<void>(); };

 private:
  std::vector<Task> tasks_;
  bool opens_, opened_ = false, is_spent_ = false;
  int done_since_open_ = 0;
};

Task says(const std::string& word) {
  return [word]() -> Result<std::string> { return word; };
}
Task slowly(const std::string& word) {
  return [word]() -> Result<std::string> {
    ::usleep(50'000);
    return word;
  };
}
Result<std::string> breaks() { return fail("broken"); }

Jobs<std::string> jobs_of(const std::vector<std::vector<Task>>& all, bool open = true) {
  Jobs<std::string> jobs;
  for (const auto& tasks : all) jobs.push_back(std::make_unique<FakeJob>(tasks, open));
  return jobs;
}

JobOptions<std::string> with(int processes) {
  JobOptions<std::string> options;
  options.processes = processes;
  return options;
}

JobOptions<std::string> in_process() {
  JobOptions<std::string> options;
  options.in_process = true;
  return options;
}

TEST(Jobs, ResultsAreInOrderWhateverFinishesFirst) {
  const auto jobs = jobs_of({{slowly("a"), says("b")}, {says("c")}, {slowly("d")}, {says("e")}});
  for (const int processes : {1, 2, 4, 50}) {
    EXPECT_THAT(run_jobs(jobs, with(processes)).results, ElementsAre("a", "b", "c", "d", "e"));
  }
  EXPECT_THAT(run_jobs(jobs, in_process()).results, ElementsAre("a", "b", "c", "d", "e"));
}

TEST(Jobs, ASpentJobIsOpenedAgain) {
  const auto jobs = jobs_of({{says("counts"), says("spent"), says("counts"), says("counts")}});
  for (const auto& options : {with(1), in_process()}) {
    EXPECT_THAT(run_jobs(jobs, options).results,
                ElementsAre("task 1", "spent", "task 1", "task 2"));
  }
}

Result<std::string> process_and_first_job() {
  return fmt::format("process {} began with {}", ::getpid(), FakeJob::worker_began_with);
}

TEST(Jobs, AWorkerRunsJobsOneAfterTheOther) {
  const Task says_where = process_and_first_job;
  const auto results = run_jobs(jobs_of({{says_where}, {says_where, says_where}}), with(1)).results;
  ASSERT_EQ(results.size(), 3u);
  EXPECT_THAT(results[0], testing::EndsWith("began with 1"));
  EXPECT_THAT(results, testing::Each(results[0]));
}

TEST(Jobs, AfterAJobThatEndsItsWorkerTheOthersHaveAnotherWorker) {
  FakeJob::ends_worker_after = 1;
  const Task says_where = process_and_first_job;
  const auto outcome = run_jobs(
      jobs_of({{says_where}, {says_where, says_where}, {says_where}, {says_where}}), with(1));
  FakeJob::ends_worker_after = 1000;
  EXPECT_THAT(outcome.errors, IsEmpty());
  ASSERT_EQ(outcome.results.size(), 5u);
  EXPECT_THAT(outcome.results[0], testing::EndsWith("began with 1"));
  EXPECT_THAT(outcome.results[1], testing::EndsWith("began with 2"));
}

// It has no process for a launcher, for example.
TEST(Jobs, TheOtherWorkersDoTheWorkOfOneThatCannotBegin) {
  const TemporaryDirectory folder;
  const auto first = folder.path() / "first";
  FakeJob::worker_begins = [&]() -> Result<void> {
    if (std::filesystem::create_directory(first)) return {};
    return fail("too many processes");
  };
  const auto jobs = jobs_of({{slowly("a")}, {slowly("b")}, {slowly("c")}, {says("d")}});
  const auto outcome = run_jobs(jobs, with(3));
  EXPECT_THAT(outcome.results, ElementsAre("a", "b", "c", "d"));
  EXPECT_THAT(outcome.errors, IsEmpty());
  const auto alone = run_jobs(jobs, with(1));
  FakeJob::worker_begins = [] { return Result<void>(); };
  EXPECT_THAT(alone.results, IsEmpty());
  ASSERT_EQ(alone.errors.size(), 4u);
  EXPECT_EQ(alone.errors[0].message, "too many processes");
}

TEST(Jobs, AfterADeathTheOtherJobsHaveAnotherWorker) {
  const Task says_where = process_and_first_job;
  const Task dies = []() -> Result<std::string> { std::abort(); };
  const auto results =
      run_jobs(jobs_of({{says_where}, {dies}, {says_where, says_where}}), with(1)).results;
  ASSERT_EQ(results.size(), 3u);
  EXPECT_THAT(results[0], testing::EndsWith("began with 1"));
  EXPECT_THAT(results[1], testing::EndsWith("began with 2"));
  EXPECT_EQ(results[1], results[2]);
}

TEST(Jobs, AnErrorIsOfItsTask) {
  for (const auto& options : {with(2), in_process()}) {
    const auto outcome = run_jobs(jobs_of({{says("a"), breaks, says("b")}, {says("c")}}), options);
    EXPECT_THAT(outcome.results, ElementsAre("a", "b", "c"));
    ASSERT_EQ(outcome.errors.size(), 1u);
    EXPECT_EQ(outcome.errors[0].message, "broken");
  }
}

TEST(Jobs, OneThatDoesNotOpenIsOneError) {
  for (const auto& options : {with(2), in_process()}) {
    const auto outcome = run_jobs(jobs_of({{says("a"), says("b")}}, false), options);
    EXPECT_THAT(outcome.results, IsEmpty());
    ASSERT_EQ(outcome.errors.size(), 1u);
    EXPECT_EQ(outcome.errors[0].message, "no golden");
  }
}

// A worker has no port in it, so this is a bug of attest: the run has an error.
TEST(Jobs, AWorkerThatDiesIsAnError) {
  const Task dies = []() -> Result<std::string> {
    std::fputs("an assertion\n", stderr);
    std::abort();
  };
  const auto outcome = run_jobs(jobs_of({{says("a"), dies}, {says("b")}}), with(1));
  EXPECT_THAT(outcome.results, ElementsAre("a", "b"));
  EXPECT_FALSE(outcome.stopped_early);
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_THAT(outcome.errors[0].message, HasSubstr("was killed by signal 6"));
  EXPECT_THAT(outcome.errors[0].message, HasSubstr("an assertion"));
}

// Another process could give other answers to the open tasks.
TEST(Jobs, AWorkerThatDiesIsNotStartedAgain) {
  const TemporaryDirectory directory;
  const auto marker = directory.path() / "has_died";
  const Task dies_once = [marker]() -> Result<std::string> {
    if (std::filesystem::exists(marker)) return "b";
    std::ofstream(marker) << "";
    std::abort();
  };
  const auto outcome = run_jobs(jobs_of({{says("a"), dies_once}}), with(1));
  EXPECT_THAT(outcome.results, ElementsAre("a"));
  EXPECT_EQ(outcome.errors.size(), 1u);
}

TEST(Jobs, AProcessThatCannotBeStartedIsAnErrorOfItsJob) {
  if (!memory_is_limited()) GTEST_SKIP() << "a sanitizer opens files of its own";
  rlimit files{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &files), 0);
  rlimit none = files;
  none.rlim_cur = 3;
  ::setrlimit(RLIMIT_NOFILE, &none);
  const auto outcome = run_jobs(jobs_of({{says("a")}, {says("b")}}), with(2));
  ::setrlimit(RLIMIT_NOFILE, &files);
  EXPECT_THAT(outcome.results, IsEmpty());
  ASSERT_EQ(outcome.errors.size(), 2u);
  EXPECT_THAT(outcome.errors[0].message, HasSubstr("`ulimit -n`"));
}

TEST(Jobs, AWorkerThatEndsWithoutAnAnswerIsAnError) {
  const Task ends = []() -> Result<std::string> { ::_exit(EXIT_SUCCESS); };
  const auto outcome = run_jobs(jobs_of({{ends, says("a")}, {says("b")}}), with(1));
  EXPECT_THAT(outcome.results, ElementsAre("b"));
  EXPECT_EQ(outcome.errors.size(), 1u);
}

TEST(Jobs, FailFastEndsWithTheFirstResultThatFailsInTheirOrder) {
  const auto jobs = jobs_of({{slowly("good")}, {slowly("bad"), says("good")}, {says("bad")}});
  for (auto options : {with(1), with(4), in_process()}) {
    options.fail_fast = true;
    options.fails = [](const std::string& result) { return result == "bad"; };
    const auto outcome = run_jobs(jobs, options);
    EXPECT_THAT(outcome.results, ElementsAre("good", "bad"));
    EXPECT_TRUE(outcome.stopped_early);
  }
}

TEST(Jobs, FailFastDoesNotRunTheRestOfAJob) {
  const TemporaryDirectory folder;
  const auto mark = folder.path() / "ran";
  const Task leaves_a_mark = [&]() -> Result<std::string> {
    std::ofstream(mark) << "x";
    return "more";
  };
  const auto jobs = jobs_of({{says("good"), says("bad"), leaves_a_mark}});
  for (auto options : {with(1), in_process()}) {
    options.fail_fast = true;
    options.fails = [](const std::string& result) { return result == "bad"; };
    const auto outcome = run_jobs(jobs, options);
    EXPECT_THAT(outcome.results, ElementsAre("good", "bad"));
    EXPECT_TRUE(outcome.stopped_early);
    EXPECT_FALSE(std::filesystem::exists(mark));
  }
}

TEST(Jobs, AFailureAtTheEndStopsNothing) {
  const auto jobs = jobs_of({{says("good")}, {says("good"), says("bad")}});
  for (auto options : {with(2), in_process()}) {
    options.fail_fast = true;
    options.fails = [](const std::string& result) { return result == "bad"; };
    EXPECT_FALSE(run_jobs(jobs, options).stopped_early);
    EXPECT_EQ(run_jobs(jobs, options).results.size(), 3u);
  }
}

TEST(Jobs, EveryResultIsReportedOnce) {
  for (auto options : {with(3), in_process()}) {
    std::vector<std::string> seen;
    options.on_result = [&](const std::string& result) { seen.push_back(result); };
    run_jobs(jobs_of({{says("a"), says("b")}, {says("c")}, {says("d")}}), options);
    EXPECT_THAT(seen, testing::UnorderedElementsAre("a", "b", "c", "d"));
  }
}

TEST(Jobs, StopOnRequest) {
  for (auto options : {with(1), in_process()}) {
    int seen = 0;
    options.on_result = [&](const std::string&) { ++seen; };
    options.stop = [&] { return seen > 0; };
    run_jobs(jobs_of({{says("a")}, {says("b")}, {says("c")}}), options);
    EXPECT_EQ(seen, 1);
  }
}

// A worker that is forked just after an interrupt sees the request, its parent a moment later.
TEST(Jobs, AWorkerThatIsAskedToStopRunsNoTask) {
  const TemporaryDirectory folder;
  const auto mark = folder.path() / "ran";
  const Task leaves_a_mark = [&]() -> Result<std::string> {
    std::ofstream(mark) << "x";
    return "a";
  };
  auto options = with(1);
  options.stop = [parent = ::getpid()] { return ::getpid() != parent; };
  run_jobs(jobs_of({{leaves_a_mark}}), options);
  EXPECT_FALSE(std::filesystem::exists(mark));
}

TEST(Jobs, NothingToDoIsDone) {
  EXPECT_THAT(run_jobs(Jobs<std::string>(), with(2)).results, IsEmpty());
  EXPECT_THAT(run_jobs(jobs_of({{}, {says("a")}}), with(1)).results, ElementsAre("a"));
  // The smallest number of workers.
  EXPECT_EQ(run_jobs(jobs_of({{says("a")}}), with(0)).results.size(), 1u);
}

}  // namespace
}  // namespace attest
