// A private folder for files that are needed only while a command works.
#pragma once

#include <filesystem>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

// A new folder in TMPDIR (default: /tmp) that only the user can read. The destructor removes it
// with its content.
class TemporaryFolder {
 public:
  // `purpose` becomes a part of the folder's name. Errors: the folder cannot be made.
  static Result<TemporaryFolder> make(std::string_view purpose);
  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;  // empty after a move
};

}  // namespace attest
