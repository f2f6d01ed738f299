#include "benchmarks/memory.hpp"

#include <array>
#include <cstdlib>
#include <functional>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/suite/select.hpp"
#include "harness/suite/worker.hpp"

namespace attest::bench {
namespace {

constexpr int jobs = 2;
constexpr double bound_mb = 200;

struct Peak {
  double process_mb = 0, child_mb = 0;  // largest of its children
};

double peak_mb(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // kilobytes
}

// Of `work` in a process of its own, started from one that has done nothing yet.
Peak peak_of(const std::function<void()>& work) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return {};
  const pid_t process = ::fork();
  if (process == 0) {
    work();
    const Peak peak{peak_mb(RUSAGE_SELF), peak_mb(RUSAGE_CHILDREN)};
    const bool written = ::write(ends[1], &peak, sizeof peak) == sizeof peak;
    ::_exit(written ? EXIT_SUCCESS : EXIT_FAILURE);
  }
  ::close(ends[1]);
  Peak peak;
  const bool read = ::read(ends[0], &peak, sizeof peak) == sizeof peak;
  ::close(ends[0]);
  ::waitpid(process, nullptr, 0);
  return read ? peak : Peak{};
}

void whole_suite() {
  const auto cases = select_cases(ATTEST_SOURCE_DIR "/cases", {});
  Fleet fleet(ATTEST_SOURCE_DIR "/models");
  const auto batches = make_batches(*cases, ATTEST_SOURCE_DIR "/golden", fleet, Level::numeric);
  WorkerOptions options;
  options.jobs = jobs;
  run_batches(*batches, options);
}

}  // namespace

std::string memory_table(bool& met) {
  const Peak suite = peak_of(whole_suite);
  const double all = suite.process_mb + jobs * suite.child_mb;
  const bool holds = suite.process_mb > 0 && all <= bound_mb;
  met = met && holds;
  return fmt::format(
      "| memory | main process | largest worker | all, {} jobs | claimed | |\n"
      "|---|---|---|---|---|---|\n"
      "| whole suite, peak | {:.0f} MB | {:.0f} MB | {:.0f} MB | at most {:g} MB | {} |\n",
      jobs, suite.process_mb, suite.child_mb, all, bound_mb, holds ? "met" : "MISSED");
}

}  // namespace attest::bench
