// The barrier between a process that runs code of others, and attest: the suite's files, the
// processes that judge, and the limits. All processes that the code starts are behind the same
// barrier. The system enforces it; the code cannot lift it, not even as root.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

struct BarrierOptions {
  // Files and folders that the process can neither read nor change, such as goldens. All other
  // files stay as they are, except: in a folder above a hidden one, files that do not exist yet
  // cannot be made. Paths that do not exist are ignored.
  std::vector<std::string> hidden;
  // Below a hidden path; the process can read them, but not change them.
  std::vector<std::string> readable;
};

// The parts of the barrier that depend on the kernel. Everywhere, the process cannot read or write
// the memory of attest, and cannot raise its limits.
struct BarrierParts {
  bool files = false;    // hidden files: Landlock, Linux 5.13
  bool signals = false;  // no signals to processes outside: Landlock's scopes, Linux 6.12

  bool operator==(const BarrierParts&) const = default;
};
BarrierParts barrier_parts();

// The missing parts, for reports: "files of the suite".
std::vector<std::string> missing_parts(const BarrierParts& parts);

class Barrier {
 public:
  // Errors: the kernel has the barrier but cannot make it, for example without descriptors.
  static Result<Barrier> make(const BarrierOptions& options);

  Barrier(Barrier&& other) noexcept;
  Barrier& operator=(Barrier&&) = delete;
  ~Barrier();

  // Puts the calling process behind the barrier. Called in a new process, before it runs code of
  // others. Ends the process if the system refuses.
  void enter() const;

 private:
  Barrier(int rules, std::string filter) : rules_(rules), filter_(std::move(filter)) {}

  int rules_;           // descriptor of Landlock's rules; -1: the kernel has none
  std::string filter_;  // of system calls, as the kernel takes it
};

// Makes the memory of this process, and of its forks until Barrier::enter(), unreadable for other
// processes of the same user.
void hide_memory();

}  // namespace attest
