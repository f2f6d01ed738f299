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
  bool fail_fast = false;   // leave out all after the first result that fails, and after an error
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

// Calls `done` with each result and the number of tasks that it is for. If `done` returns false,
// the tasks that are left have an error together.
template <typename R, typename Done>
void run_tasks(Job<R>& job, Done&& done) {
  const auto leave_out_from = [&](std::size_t task, const Error& error) {
    job.close();
    if (task < job.size()) done(Result<R>(tl::unexpected(error)), job.size() - task);
  };
  for (std::size_t task = 0; task < job.size();) {
    if (const auto opened = job.open(); !opened) return leave_out_from(task, opened.error());
    do {
      const bool goes_on = done(job.run(task), 1);
      if (++task; !goes_on) return leave_out_from(task, {"left out after a failure"});
    } while (task < job.size() && !job.is_spent());
    job.close();
  }
}

// False: nothing after this result is needed.
template <typename R>
bool goes_on_after(const Result<R>& result, const JobOptions<R>& options) {
  return !options.fail_fast || (result && !options.fails(*result));
}

// Collects the results of the jobs.
template <typename R>
class Collector {
 public:
  Collector(std::size_t jobs, const JobOptions<R>& options) : options_(options), of_jobs_(jobs) {}

  // fail() and take() return false if the rest of `job` and the jobs after it are not needed. What
  // then comes of `job` is left out. An error that several tasks in a row have is kept once.
  bool fail(std::size_t job, const Error& error) { return take(job, tl::unexpected(error)); }
  bool take(std::size_t job, Result<R> result) {
    Each& each = of_jobs_[job];
    if (each.is_over) {
      leaves_out_ = true;
      return false;
    }
    each.is_over = !goes_on_after(result, options_);
    if (result) {
      options_.on_result(*result);
      each.results.push_back(*std::move(result));
    } else if (each.errors.empty() ||
               each.errors.back().to_string() != result.error().to_string()) {
      each.errors.push_back(result.error());
    }
    return !each.is_over;
  }

  JobResults<R> finish(std::size_t end) {
    JobResults<R> all;
    all.stopped_early = leaves_out_ || end < of_jobs_.size();
    for (std::size_t i = 0; i < end; ++i) {
      auto& [results, errors, is_over] = of_jobs_[i];
      std::move(results.begin(), results.end(), std::back_inserter(all.results));
      std::move(errors.begin(), errors.end(), std::back_inserter(all.errors));
    }
    return all;
  }

 private:
  struct Each {
    std::vector<R> results;
    std::vector<Error> errors;
    bool is_over = false;
  };
  const JobOptions<R>& options_;
  std::vector<Each> of_jobs_;
  bool leaves_out_ = false;
};

template <typename R>
JobResults<R> run_here(const Jobs<R>& jobs, const JobOptions<R>& options) {
  Collector<R> collector(jobs.size(), options);
  std::size_t end = 0;
  for (bool goes_on = true; goes_on && end < jobs.size() && !options.stop(); ++end) {
    run_tasks(*jobs[end], [&](Result<R> result, std::size_t) {
      return goes_on = collector.take(end, std::move(result)) && goes_on;
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
                    [&job, &options](const Work::Done& done) {
                      detail::run_tasks(*job, [&](const Result<R>& result, std::size_t tasks) {
                        done(Codec<R>::encode(result), tasks);
                        return detail::goes_on_after(result, options);
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
