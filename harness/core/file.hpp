// Whole files: read, hashed, and written so that a reader never sees half of one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

// Opens a regular file for reading; the caller closes the descriptor. Everything that attest reads
// is opened here. Errors: anything else, which may have no end (a device), nobody who writes (a
// pipe) or no bytes (a directory). Opening never waits.
Result<int> open_regular_file(const std::filesystem::path& path);

// More than any text that a person writes. What a program wrote may need more.
inline constexpr std::uintmax_t most_text_bytes = std::uintmax_t{64} << 20;

// The whole file. Errors: those of open_regular_file(), unreadable, more than `most_bytes`.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::uintmax_t most_bytes = most_text_bytes);

// SHA-256 as 64 lower-case hex digits, as `sha256sum` prints it.
std::string sha256(std::string_view bytes);
Result<std::string> sha256_of_file(const std::filesystem::path& path);

// A file that is written beside its place and renamed at commit(). Opening it early shows an
// unwritable path before the work, not after; without commit() nothing is left behind, nor when the
// process is killed, where the file system has files without a name. What is not an ordinary file
// (/dev/stdout, /dev/null, a pipe) is written to directly.
class AtomicFile {
 public:
  static Result<AtomicFile> open(const std::filesystem::path& path);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  const std::filesystem::path& path() const { return path_; }
  // REQUIRES, for both: not committed yet.
  Result<void> write(std::string_view bytes);
  // Flushes to disk and renames. Errors (disk full, directory gone) leave the old file as it was.
  Result<void> commit();

 private:
  AtomicFile(std::filesystem::path path, std::filesystem::path target,
             std::filesystem::path temporary, int descriptor);

  std::filesystem::path path_;       // as given, for messages
  std::filesystem::path target_;     // with symbolic links followed; empty: written directly
  std::filesystem::path temporary_;  // what it is called until then; empty: nothing
  int descriptor_;                   // -1 once committed
};

// The whole of a file through the above. An empty path is no file: nothing is written.
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace attest
