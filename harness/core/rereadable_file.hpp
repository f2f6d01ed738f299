// Input from a pipe, for readers that open their file more than once.
#pragma once

#include <chrono>
#include <filesystem>
#include <utility>

#include "harness/core/result.hpp"

namespace attest {

// A file that can be read more than once: a regular file itself, or a copy of all that comes
// from a pipe. The copy is in memory and ends with this object.
class RereadableFile {
 public:
  // Reads a pipe to its end, and waits for its writer. Opens nothing else. Errors: the pipe has no
  // writer and no data within that time; it has more than 1 GiB.
  static Result<RereadableFile> open(
      const std::filesystem::path& path,
      std::chrono::milliseconds writer_within = std::chrono::seconds(5));
  RereadableFile(RereadableFile&& other) noexcept;
  RereadableFile& operator=(RereadableFile&&) = delete;
  ~RereadableFile();

  bool is_copy() const { return copy_ >= 0; }
  const std::filesystem::path& path() const { return path_; }  // to open it by

 private:
  RereadableFile(std::filesystem::path path, int copy) : path_(std::move(path)), copy_(copy) {}

  std::filesystem::path path_;
  int copy_;  // descriptor of the copy; -1: the file itself
};

}  // namespace attest
