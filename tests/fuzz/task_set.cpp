// Task sets. One that is read is simulated or refused with a reason. Each job runs after its
// release, and no response is longer than the computed bound.
#include "harness/casefile/task_set.hpp"

#include "harness/core/response_time.hpp"
#include "harness/loop/scheduled_timing.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

constexpr Nanoseconds duration{2'000'000};
constexpr std::size_t most_tasks = 20;

void require_in_order(const std::vector<TaskJob>& jobs, std::optional<Nanoseconds> bound) {
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const TaskJob& job = jobs[i];
    require(job.release <= job.start && job.start < job.finish, "a job runs after its release");
    require(i == 0 || jobs[i - 1].finish <= job.start, "jobs of a task run one after the other");
    require(!bound || job.response() <= *bound, "no response is longer than the bound");
  }
}

void use(const TaskSet& set) {
  const auto jobs = simulate(set.tasks, duration);
  if (!jobs) return require_readable(jobs.error().message);
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    require_in_order((*jobs)[i], response_time(set.tasks, i));
  }
  const std::vector<TaskJob>* estimator = set.estimator ? &(*jobs)[*set.estimator] : nullptr;
  const LoopTiming timing = scheduled_timing((*jobs)[set.unit], estimator);
  require(timing.size() == (*jobs)[set.unit].size(), "each job of the unit is a tick");
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest;
  const auto file = fuzz::write("tasks.toml", fuzz::text_of(data, size));
  const auto set = read_task_set(file);
  if (!set) {
    fuzz::require_readable(set.error(), file);
  } else if (set->tasks.size() <= fuzz::most_tasks) {
    fuzz::use(*set);
  }
  return 0;
}
