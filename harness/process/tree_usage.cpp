#include "harness/process/tree_usage.hpp"

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include "harness/process/orphans.hpp"

namespace attest {
namespace {

std::chrono::nanoseconds running_time(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return {};
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

// The second number of each /proc/PID/task/TID/schedstat (Documentation/scheduler/sched-stats.rst
// of Linux).
std::chrono::nanoseconds waiting_time(const std::string& folder) {
  std::chrono::nanoseconds sum{0};
  std::error_code gone;
  std::filesystem::directory_iterator task(folder + "/task", gone);
  for (; !gone && task != end(task); task.increment(gone)) {
    std::ifstream file(task->path() / "schedstat");
    std::int64_t running = 0, waiting = 0;
    if (file >> running >> waiting) sum += std::chrono::nanoseconds(waiting);
  }
  return sum;
}

std::size_t resident_bytes(const std::string& folder) {
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  std::ifstream file(folder + "/statm");
  std::size_t size = 0, resident = 0;
  return file >> size >> resident ? resident * page : 0;
}

}  // namespace

TreeUsage usage_of_tree(pid_t root) {
  TreeUsage usage;
  for (const pid_t process : with_descendants({root})) {
    const std::string folder = "/proc/" + std::to_string(process);
    usage.running += running_time(process);
    usage.waiting += waiting_time(folder);
    usage.resident_bytes += resident_bytes(folder);
  }
  return usage;
}

}  // namespace attest
