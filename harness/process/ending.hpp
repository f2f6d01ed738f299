// How a process ended.
#pragma once

#include <optional>
#include <string>

namespace attest {

// How long to wait for the end of a killed process. The kernel ends it immediately, unless it waits
// for a device.
inline constexpr double time_to_die_s = 5;

struct Ending {
  bool was_killed = false;         // by its owner
  std::optional<int> wait_status;  // of waitpid(); empty: no process, or SIGKILL did not end it

  bool is_success() const;  // it exited with status 0

  // "was killed by signal 11 (Segmentation fault)", "exited with status 0".
  std::string to_string() const;
};

}  // namespace attest
