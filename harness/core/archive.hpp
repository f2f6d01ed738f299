// Reads zip archives.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// The list of the files in an archive, and their bytes on request. Between calls it has neither an
// open descriptor nor bytes of the files, so a fork does not give them to a port. For one thread; a
// forked process can read on.
class Archive {
 public:
  // Errors: the file cannot be opened, or is no archive; it has a name that leads out of a folder,
  // or twice the same name.
  static Result<Archive> open(const std::filesystem::path& path);
  Archive(Archive&&) noexcept;
  Archive& operator=(Archive&&) = delete;
  ~Archive();

  // In the order of their bytes, such as "cases/CORE"; without folders.
  const std::vector<std::string>& names() const;

  // The bytes of the file `name`; `file` is its path in messages. Errors: there is no such file; it
  // is damaged, or larger than a file that read_file() reads; the archive was changed since open().
  Result<std::string> read(const std::string& name, const std::filesystem::path& file) const;

  // Keeps the archive open while the result exists, so that many files are read in less time. No
  // process may be forked meanwhile.
  std::shared_ptr<const void> keep_open() const;

 private:
  struct Contents;
  explicit Archive(std::unique_ptr<Contents> contents);

  std::unique_ptr<Contents> contents_;
};

}  // namespace attest
