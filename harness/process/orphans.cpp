#include "harness/process/orphans.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/wait.h>

#include "harness/process/ending.hpp"
#include "harness/process/happens_within.hpp"

namespace attest {

Owned& owned() {
  static Owned all;
  return all;
}

namespace {

// The children of `process`, a number or "self". Empty if `process` has ended.
std::vector<pid_t> children(const std::string& process) {
  std::vector<pid_t> found;
  std::error_code gone;
  std::filesystem::directory_iterator task("/proc/" + process + "/task", gone);
  for (; !gone && task != end(task); task.increment(gone)) {
    std::ifstream list(task->path() / "children");
    for (pid_t child = 0; list >> child;) found.push_back(child);
  }
  return found;
}

}  // namespace

std::vector<pid_t> with_descendants(std::vector<pid_t> processes) {
  constexpr std::size_t enough = 10'000;  // a limit: processes may fork faster than this loop
  for (std::size_t i = 0; i < processes.size() && processes.size() < enough; ++i) {
    const std::vector<pid_t> next = children(std::to_string(processes[i]));
    processes.insert(processes.end(), next.begin(), next.end());
  }
  return processes;
}

void end_orphans() {
  // Reading /proc costs 100 page faults, and is not necessary without children.
  siginfo_t ignored{};
  if (::waitid(P_ALL, 0, &ignored, WEXITED | WNOHANG | WNOWAIT) != 0 && errno == ECHILD) return;
  const std::lock_guard lock(owned().mutex);
  happens_within(time_to_die_s, [] {
    std::vector<pid_t> found = children("self");
    std::erase_if(found, [](pid_t child) { return owned().processes.contains(child); });
    const std::vector<pid_t> all = with_descendants(std::move(found));
    for (const pid_t orphan : all) ::kill(orphan, SIGKILL);
    for (const pid_t orphan : all) ::waitpid(orphan, nullptr, WNOHANG);
    return all.empty();
  });
}

}  // namespace attest
