// How a process ended.
#pragma once

#include <optional>
#include <string>

namespace attest {

// The time that a killed process gets. The kernel ends it immediately, unless it waits for a
// device.
inline constexpr double time_to_die_s = 5;

struct Ending {
  bool was_killed = false;         // by us
  std::optional<int> wait_status;  // of waitpid(); empty: not even SIGKILL ended it in time

  bool is_success() const;  // it exited with status 0

  // As a verb: "was killed by signal 11 (Segmentation fault)", "exited with status 0".
  std::string to_string() const;
};

}  // namespace attest
