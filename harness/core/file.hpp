// Whole files: reads them, hashes them, and writes them so that a reader never sees a partial file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

// Opens a regular file for reading; the caller closes the descriptor. All files that attest reads
// are opened here. Errors: other kinds of file, which may have no end (a device), no writer (a
// pipe) or no bytes (a directory). Opening never waits.
Result<int> open_regular_file(const std::filesystem::path& path);

// More than any text that a person writes. A file written by a program may need a higher limit.
inline constexpr std::uintmax_t most_text_bytes = std::uintmax_t{64} << 20;

// Reads the whole file. Errors: those of open_regular_file(), unreadable, more than `most_bytes`.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::uintmax_t most_bytes = most_text_bytes);

// SHA-256 as 64 lower-case hex digits, as `sha256sum` prints it.
std::string sha256(std::string_view bytes);
Result<std::string> sha256_of_file(const std::filesystem::path& path);

// A file that is written in the same folder as its target and renamed at commit(). Open it early,
// to find an unwritable path before the work. Without commit() it leaves no file behind. If the
// file system supports files without a name, this is also so when the process is killed. Other
// kinds of file (/dev/stdout, /dev/null, a pipe) are written to directly. `-` is stdout; all that
// the process prints there after open() goes to stderr.
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
  std::filesystem::path temporary_;  // its name until commit(); empty: it has no name
  int descriptor_;                   // -1 once committed
};

// Writes a whole file with AtomicFile. For an empty path it does nothing.
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace attest
