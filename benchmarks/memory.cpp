#include "benchmarks/memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/suite/select.hpp"
#include "harness/suite/worker.hpp"

namespace attest::bench {
namespace {

constexpr int jobs = 2;
constexpr double bound_mb = 200;

// Memory of a process that is its own, and its part of what it shares, as workers share what was
// there before they were forked (PSS); in kB.
long proportional_kb(const std::string& process) {
  std::ifstream rollup("/proc/" + process + "/smaps_rollup");
  for (std::string line; std::getline(rollup, line);) {
    if (line.starts_with("Pss:")) return std::strtol(line.c_str() + 4, nullptr, 10);
  }
  return 0;  // it has ended
}

long with_children_kb(pid_t process) {
  const std::string name = fmt::to_string(process);
  long sum = proportional_kb(name);
  std::ifstream children(fmt::format("/proc/{}/task/{}/children", name, name));
  for (std::string child; children >> child;) sum += proportional_kb(child);
  return sum;
}

// Of `work` in a process of its own, with the workers it has at a time; looked at all the time.
double peak_mb(const std::function<void()>& work) {
  const pid_t process = ::fork();
  if (process == 0) {
    work();
    ::_exit(EXIT_SUCCESS);
  }
  long peak = 0;
  while (::waitpid(process, nullptr, WNOHANG) == 0) {
    peak = std::max(peak, with_children_kb(process));
    ::usleep(20'000);
  }
  return static_cast<double>(peak) / 1024;
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
  const double suite = peak_mb(whole_suite);
  const bool holds = suite > 0 && suite <= bound_mb;
  met = met && holds;
  return fmt::format(
      "| memory | peak | claimed | |\n"
      "|---|---|---|---|\n"
      "| whole suite, {} jobs, all processes together | {:.0f} MB | at most {:g} MB | {} |\n",
      jobs, suite, bound_mb, holds ? "met" : "MISSED");
}

}  // namespace attest::bench
