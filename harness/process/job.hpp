// A job: tasks in a row, each with a result of the type R. Jobs run in a chosen number of worker
// processes, and the results are the same for any number of processes.
#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/process/pool.hpp"

namespace attest {

template <typename R>
class Job {
 public:
  virtual ~Job() = default;

  virtual std::size_t size() const = 0;  // tasks

  // Called before open() in a worker process whose first job this is. The process may run other
  // jobs of the same kind afterwards. After an error another worker runs the job; if there is no
  // other worker, the error becomes an error of the job. Not called with JobOptions::in_process.
  virtual Result<void> begin_worker() { return {}; }

  // Called after the last close(). True if the worker must not run other jobs.
  virtual bool ends_worker() const { return false; }

  // Called before the first task, and again after is_spent(). An error applies to all tasks not yet
  // run, which are left out.
  virtual Result<void> open() { return {}; }

  // REQUIRES: open() succeeded.
  virtual Result<R> run(std::size_t task) = 0;

  // Called after a task. True if the job must be closed and opened again before the next task.
  virtual bool is_spent() const { return false; }

  // Undoes open(). Called after the last task, when is_spent(), and after an open() that failed.
  virtual void close() {}
};

template <typename R>
using Jobs = std::vector<std::unique_ptr<Job<R>>>;

// Converts a result to text, to send it from a worker to its parent. Specialised for each type:
//
//     static std::string encode(const Result<R>& result);
//     static Result<R> decode(const std::string& text);
template <typename R>
struct Codec;

template <typename R>
struct JobOptions {
  int processes = 1;
  bool in_process = false;  // for a debugger: jobs run one after the other in this process
  bool fail_fast = false;   // leave out all jobs after the first one that fails or has an error
  std::function<void(const R&)> on_result = [](const R&) {};
  std::function<bool(const R&)> fails = [](const R&) { return false; };
  std::function<bool()> stop = [] { return false; };  // true: end soon, results are not needed
};

template <typename R>
struct JobResults {
  std::vector<R> results;     // in the order of jobs and tasks
  std::vector<Error> errors;  // in the same order
  bool stopped_early = false;
};

namespace detail {

// Calls `done` with each result and the number of tasks that it is for.
template <typename R, typename Done>
void run_tasks(Job<R>& job, Done&& done) {
  for (std::size_t task = 0; task < job.size();) {
    if (const auto opened = job.open(); !opened) {
      job.close();
      return done(Result<R>(tl::unexpected(opened.error())), job.size() - task);
    }
    do {
      done(job.run(task), 1);
    } while (++task < job.size() && !job.is_spent());
    job.close();
  }
}

// Collects the results of the jobs.
template <typename R>
class Collector {
 public:
  Collector(std::size_t jobs, const JobOptions<R>& options) : options_(options), of_jobs_(jobs) {}

  // fail() and take() return false if the jobs after `job` are not needed. An error that several
  // tasks in a row have is kept once.
  bool fail(std::size_t job, const Error& error) {
    std::vector<Error>& errors = of_jobs_[job].errors;
    if (errors.empty() || errors.back().to_string() != error.to_string()) errors.push_back(error);
    return !options_.fail_fast;
  }
  bool take(std::size_t job, Result<R> result) {
    if (!result) return fail(job, result.error());
    Each& each = of_jobs_[job];
    options_.on_result(*result);
    const bool fails = options_.fails(*result);
    each.results.push_back(*std::move(result));
    return !(options_.fail_fast && fails);
  }

  JobResults<R> finish(std::size_t end) {
    JobResults<R> all;
    all.stopped_early = end < of_jobs_.size();
    for (std::size_t i = 0; i < end; ++i) {
      auto& [results, errors] = of_jobs_[i];
      std::move(results.begin(), results.end(), std::back_inserter(all.results));
      std::move(errors.begin(), errors.end(), std::back_inserter(all.errors));
    }
    return all;
  }

 private:
  struct Each {
    std::vector<R> results;
    std::vector<Error> errors;
  };
  const JobOptions<R>& options_;
  std::vector<Each> of_jobs_;
};

template <typename R>
JobResults<R> run_here(const Jobs<R>& jobs, const JobOptions<R>& options) {
  Collector<R> collector(jobs.size(), options);
  std::size_t end = 0;
  for (bool goes_on = true; goes_on && end < jobs.size() && !options.stop(); ++end) {
    run_tasks(*jobs[end], [&](Result<R> result, std::size_t) {
      goes_on = collector.take(end, std::move(result)) && goes_on;
    });
  }
  return collector.finish(end);
}

}  // namespace detail

template <typename R>
JobResults<R> run_jobs(const Jobs<R>& jobs, const JobOptions<R>& options) {
  if (options.in_process) return detail::run_here(jobs, options);
  std::vector<Work> work;
  for (const auto& job : jobs) {
    work.push_back({job->size(), [&job] { return job->begin_worker(); },
                    [&job](const Work::Done& done) {
                      detail::run_tasks(*job, [&](const Result<R>& result, std::size_t tasks) {
                        done(Codec<R>::encode(result), tasks);
                      });
                    },
                    [&job] { return job->ends_worker(); }});
  }
  detail::Collector<R> collector(jobs.size(), options);
  PoolOptions pool;
  pool.processes = options.processes;
  pool.stop = options.stop;
  pool.on_answer = [&](std::size_t index, const std::string& answer) {
    return collector.take(index, Codec<R>::decode(answer));
  };
  pool.on_error = [&](std::size_t index, const Error& error) {
    return collector.fail(index, error);
  };
  return collector.finish(run_in_workers(work, pool));
}

// The results of jobs that are of no use if one of them fails. Errors: the first error of the jobs;
// options.stop().
template <typename R>
Result<std::vector<R>> all_results(const Jobs<R>& jobs, const JobOptions<R>& options) {
  JobResults<R> outcome = run_jobs(jobs, options);
  if (options.stop()) return attest::fail("interrupted");
  if (!outcome.errors.empty()) return tl::unexpected(outcome.errors.front());
  return std::move(outcome.results);
}

}  // namespace attest
