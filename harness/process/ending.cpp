#include "harness/process/ending.hpp"

#include <cstdlib>
#include <cstring>

#include <fmt/format.h>
#include <sys/wait.h>

namespace attest {

bool Ending::is_success() const {
  return wait_status && WIFEXITED(*wait_status) && WEXITSTATUS(*wait_status) == EXIT_SUCCESS;
}

std::string Ending::to_string() const {
  if (!wait_status) return fmt::format("did not end within {} s of SIGKILL", time_to_die_s);
  if (WIFSIGNALED(*wait_status)) {
    const int signal = WTERMSIG(*wait_status);
    return fmt::format("was killed by signal {} ({})", signal, ::strsignal(signal));
  }
  return fmt::format("exited with status {}", WEXITSTATUS(*wait_status));
}

}  // namespace attest
