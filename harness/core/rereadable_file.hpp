// Input from a pipe or an archive, for readers that open their file more than once.
#pragma once

#include <chrono>
#include <filesystem>
#include <utility>

#include "harness/core/result.hpp"

namespace attest {

// A file that can be opened more than once: the file itself, or a copy of all that comes from a
// pipe or from an archive (suite_files.hpp). The copy is in memory, and is freed with this object.
class RereadableFile {
 public:
  // For a pipe: waits until it has a writer, and copies it to its end. Other files are not opened
  // here. Errors: the pipe has neither writer nor data within `writer_within`; it cannot be read;
  // it has more than 1 GiB; those of read_suite_file() for a file in
  // an archive.
  static Result<RereadableFile> open(
      const std::filesystem::path& path,
      std::chrono::milliseconds writer_within = std::chrono::seconds(5));
  RereadableFile(RereadableFile&& other) noexcept;
  RereadableFile& operator=(RereadableFile&&) = delete;
  ~RereadableFile();

  bool is_copy() const { return copy_ >= 0; }
  const std::filesystem::path& path() const { return path_; }  // of the file or of its copy

 private:
  RereadableFile(std::filesystem::path path, int copy) : path_(std::move(path)), copy_(copy) {}

  std::filesystem::path path_;
  int copy_;  // descriptor; -1 if there is no copy
};

}  // namespace attest
