// Only one process at a time writes goldens. It first cleans up after a process that was killed.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"

namespace attest {

// Held from take() to its destruction. It is an flock of a file in the golden root. The kernel
// releases it when the process ends in any way.
class GoldenLock {
 public:
  // Makes the root if necessary. Removes the folders `*.new` of a killed process. Moves `*.old`, a
  // golden that this process had moved away, back to its place if that is empty. Does not wait,
  // because the process that holds the lock may be waiting for its user. Errors: another process
  // holds the lock; the root or a folder in it cannot be written.
  static Result<GoldenLock> take(const std::filesystem::path& golden_root);

  GoldenLock(GoldenLock&& other) noexcept;
  GoldenLock& operator=(GoldenLock&&) = delete;
  ~GoldenLock();  // removes the file

 private:
  GoldenLock(std::filesystem::path file, int descriptor);

  std::filesystem::path file_;
  int descriptor_;
};

}  // namespace attest
