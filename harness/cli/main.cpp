// attest: is this port the same attitude controller as the reference?
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include "harness/cli/arguments.hpp"
#include "harness/cli/globals.hpp"

namespace {

// A file that is opened while stdin, stdout or stderr is closed would get the descriptor of that
// stream.
void open_standard_streams() {
  int descriptor = 0;
  do {
    descriptor = ::open("/dev/null", O_RDWR);
  } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor > STDERR_FILENO) ::close(descriptor);
}

// Whether a run with one job can open its files, sockets and processes. With fewer descriptors the
// error would come at an arbitrary place. In a port it would look like an error of the port.
bool enough_descriptors() {
  std::array<int, 24> opened{};
  std::generate(opened.begin(), opened.end(), [] { return ::open("/dev/null", O_RDONLY); });
  const bool exhausted = opened.back() < 0 && (errno == EMFILE || errno == ENFILE);
  for (const int descriptor : opened) {
    if (descriptor >= 0) ::close(descriptor);
  }
  return !exhausted;
}

// A run whose summary could not be written is not a success.
int flushed(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  std::fputs("attest: error: stdout: cannot be written\n", stderr);
  return code == attest::cli::exit_ok ? attest::cli::exit_usage : code;
}

// Memory for the samples of a trace is used again for the next one. By default malloc returns it to
// the system, and each page of the next trace costs a page fault.
void keep_freed_memory() {
  constexpr int bytes = 64 << 20;
  ::mallopt(M_MMAP_THRESHOLD, bytes / 2);  // the largest that malloc takes
  ::mallopt(M_TRIM_THRESHOLD, bytes);
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  keep_freed_memory();
  // With SIGXFSZ ignored, a write beyond `ulimit -f` fails, and the error names the file.
  std::signal(SIGXFSZ, SIG_IGN);
  // The parent may have set SIGCHLD to ignored. Then the status of an ended process would be lost.
  std::signal(SIGCHLD, SIG_DFL);
  if (!enough_descriptors()) {
    std::fputs("attest: error: too few files can be opened; raise the limit (`ulimit -n`)\n",
               stderr);
    return attest::cli::exit_usage;
  }
  try {
    return flushed(attest::cli::run_command_line(argc, argv));
  } catch (const std::bad_alloc&) {
    std::fputs("attest: error: out of memory; `ulimit -v` or the machine limits it\n", stderr);
    return attest::cli::exit_usage;
  } catch (const std::exception& error) {
    // A bug of attest.
    std::fputs(fmt::format("attest: error: {}\n", error.what()).c_str(), stderr);
    return attest::cli::exit_usage;
  }
}
