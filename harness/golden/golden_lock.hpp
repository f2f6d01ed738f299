// One process at a time writes goldens, and begins without what a killed one has left.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"

namespace attest {

// Held from take() until it is destroyed. It is an flock of a file in the golden root, which the
// kernel releases when the process dies, however that happens.
class GoldenLock {
 public:
  // Makes the root if need be. Removes the folders `*.new` of a process that was killed, and gives
  // a golden that it had moved away (`*.old`) its place again. Does not wait: who holds the lock
  // may be waiting for an answer of its user. Errors: another process holds the lock; the root or a
  // folder in it cannot be written.
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
