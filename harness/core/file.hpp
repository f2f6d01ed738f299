// Whole files: reads them, hashes them, and writes them so that a reader never sees a partial file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// Opens a regular file for reading; the caller closes the descriptor. Never waits. Errors: the file
// cannot be opened, or is not regular, because a device may have no end, a pipe may have no writer,
// and a directory has no bytes.
Result<int> open_regular_file(const std::filesystem::path& path);

// The default limit of read_file(): more than any text that a person writes. For a file written by
// a program, the caller may need a higher limit.
inline constexpr std::uintmax_t most_text_bytes = std::uintmax_t{64} << 20;

// Reads the whole file. Errors: those of open_regular_file(), unreadable, more than `most_bytes`.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::uintmax_t most_bytes = most_text_bytes);

// The file that a program writes when it opens `path`: follows symbolic links, also to a file that
// does not exist. `path` itself if it is no link, or if its links form a loop.
std::filesystem::path behind_links(std::filesystem::path path);

// The path of an existing file, for messages and reports: from the current folder if the file is
// below it, else absolute. Links are resolved.
std::string path_from_here(const std::filesystem::path& path);

// The path without `.`, `..` and doubled slashes, as far as its text alone shows.
std::string normal_form(const std::filesystem::path& path);

// The files in the folder and in those below it, in the order of the bytes of their paths. Leaves
// out pipes, devices and links without a target. Errors: a folder cannot be read.
Result<std::vector<std::filesystem::path>> files_below(const std::filesystem::path& folder);

// SHA-256 as 64 lower-case hex digits, as `sha256sum` prints it.
std::string sha256(std::string_view bytes);
// Errors: those of open_regular_file(), unreadable, more than `most_bytes`.
Result<std::string> sha256_of_file(
    const std::filesystem::path& path,
    std::uintmax_t most_bytes = std::numeric_limits<std::uintmax_t>::max());

// The SHA-256 of files at the start of a run.
class FileHashes {
 public:
  void add(const std::filesystem::path& path, std::string sha256);
  bool has(const std::filesystem::path& path) const;

  // `sha256` is the hash of the bytes that the caller parses. It does not help to hash the file on
  // disk, which may be replaced before or after it is read. Errors: the file had another hash, or
  // was not there.
  Result<void> check(const std::filesystem::path& path, const std::string& sha256) const;

 private:
  std::unordered_map<std::string, std::string> hashes_;  // by path, in lexically normal form
};

// A file that gets its name at commit(), when it is complete. Until then it is a temporary file in
// the same folder. Open it before the work, and before the code of a port runs: open() follows
// links and opens the folder, so what appears later at the path, such as a link or a pipe, is
// replaced, and neither followed nor opened. open() also finds an unwritable path. Without commit()
// the destructor removes the file. If the file system supports files without a name (O_TMPFILE), it
// also disappears when the process is killed before commit().
//
// /dev/stdout, devices and pipes are written to directly. `-` is stdout; all that the process
// prints there after open() goes to stderr. An empty path is no file: nothing is written.
class AtomicFile {
 public:
  // What open() does with a link, pipe or device at the path. `replaced`: for files in a folder
  // that this command made, in which a port can have made it.
  enum class Special { used, replaced };
  // Errors: no file name, a directory, a file that cannot be written or made; a pipe that has no
  // reader for 5 s.
  static Result<AtomicFile> open(const std::filesystem::path& path,
                                 Special special = Special::used);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  const std::filesystem::path& path() const { return path_; }
  // REQUIRES, for write() and commit(): commit() was not called before.
  Result<void> write(std::string_view bytes);
  // Flushes the file to disk and gives it its name. Errors (disk full, directory gone) leave the
  // old file as it was. A file that is written to directly is only closed.
  Result<void> commit();
  Result<void> commit(std::string_view bytes);  // write() before

 private:
  AtomicFile(std::filesystem::path path, int descriptor)
      : path_(std::move(path)), descriptor_(descriptor) {}
  static Result<AtomicFile> open_in_place(const std::filesystem::path& path);
  static Result<AtomicFile> open_new(const std::filesystem::path& path,
                                     const std::filesystem::path& target);
  int create();
  int give_name();

  std::filesystem::path path_;  // as given, or "stdout"; for messages
  int descriptor_;              // -1: no file, or committed
  int folder_ = -1;             // of the file; -1: written directly
  std::string name_;            // in folder_: that of path_, with links followed
  std::string temporary_;       // in folder_, until commit(); empty if the file has no name
};

// Writes a whole file with AtomicFile. For an empty path it does nothing.
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes,
                        AtomicFile::Special special = AtomicFile::Special::used);

}  // namespace attest
