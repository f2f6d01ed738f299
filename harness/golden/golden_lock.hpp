// Lets only one process at a time write goldens. Cleans up after a process that was killed.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"

namespace attest {

// The lock is held from take() until this object is destroyed. It is an flock of a file in the
// golden root. The kernel releases it when the process ends in any way.
class GoldenLock {
 public:
  // Makes the root if necessary. Ends what a killed bless has begun (finish_killed_bless()). Does
  // not wait, because the process that holds the lock may be waiting for its user. Errors: another
  // process holds the lock; the root cannot be made; those of finish_killed_bless().
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
