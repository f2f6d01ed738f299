// A private folder for files that are needed only while a command works.
#pragma once

#include <filesystem>
#include <string_view>

#include "harness/core/result.hpp"
#include "harness/process/process.hpp"

namespace attest {

// A new folder that only the user can read. The destructor removes it with its content. If this
// process dies, also by SIGKILL, a guard (process.hpp) removes it. REQUIRES: this process is not
// below a guard; the thread that makes the folder lives as long as the folder.
class TemporaryFolder {
 public:
  // In TMPDIR (default: /tmp). `purpose` becomes a part of the folder's name. Errors: no folder or
  // process can be made.
  static Result<TemporaryFolder> make(std::string_view purpose);
  // In `parent`. The folder's name begins with `name`.
  static Result<TemporaryFolder> make_in(const std::filesystem::path& parent,
                                         std::string_view name);
  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder(std::filesystem::path path, Process remover)
      : path_(std::move(path)), remover_(std::move(remover)) {}

  std::filesystem::path path_;  // empty after a move
  Process remover_;             // its guard removes the folder
};

}  // namespace attest
