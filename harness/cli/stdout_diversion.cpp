#include "harness/cli/stdout_diversion.hpp"

#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

namespace attest::cli {

StdoutDiversion::StdoutDiversion(bool is_wanted) {
  if (!is_wanted) return;
  std::fflush(stdout);
  stdout_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (stdout_ >= 0) ::dup2(STDERR_FILENO, STDOUT_FILENO);
}

void StdoutDiversion::end() {
  if (stdout_ < 0) return;
  std::fflush(stdout);  // a port may use the buffer of this stdout
  ::dup2(stdout_, STDOUT_FILENO);
  ::close(stdout_);
  stdout_ = -1;
}

}  // namespace attest::cli
