// Lets only one process at a time write goldens. Cleans up after a process that was killed.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"

namespace attest {

// The lock is held from take() until this object is destroyed. It is an flock of a file in the
// golden root. The kernel releases it when the process ends in any way.
class GoldenLock {
 public:
  // Makes the root if necessary. Removes the folders `*.new` of a killed process. A folder `*.old`
  // is a golden that the killed process moved away: moves it back to its place, or removes it if
  // the place has a golden. Does not wait, because the process that holds the lock may be waiting
  // for its user. Errors: another process holds the lock; the root or a folder in it cannot be
  // written.
  static Result<GoldenLock> take(const std::filesystem::path& golden_root);

  GoldenLock(GoldenLock&& other) noexcept;
  GoldenLock& operator=(GoldenLock&&) = delete;
  ~GoldenLock();  // removes the locked file

 private:
  GoldenLock(std::filesystem::path file, int descriptor);

  std::filesystem::path file_;
  int descriptor_;
};

}  // namespace attest
