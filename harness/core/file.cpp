#include "harness/core/file.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/core/interrupt.hpp"
#include "harness/core/system_failure.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

std::string_view kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory; name a file";
  if (S_ISFIFO(mode)) return "a pipe; write its content to a file first";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

// The same as the public function, and stores the status of the file.
Result<int> open_regular_file(const fs::path& path, struct stat& status) {
  // Without O_NONBLOCK, opening a pipe waits for a writer.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return cannot_open(path);
  if (::fstat(file, &status) != 0) {
    auto failure = system_failure(path, "cannot open the file");
    ::close(file);
    return failure;
  }
  if (S_ISREG(status.st_mode)) return file;
  ::close(file);
  return fail_at(path.string(), fmt::format("not a regular file but {}", kind_of(status.st_mode)));
}

// Calls begin(size) and then use(block) for each block of the file. Errors: more than `most_bytes`,
// which is checked before the file is read, and again while it is read, because it may grow.
template <typename Begin, typename Use>
Result<void> for_each_block(const fs::path& path, std::uintmax_t most_bytes, Begin begin, Use use) {
  struct stat status {};
  const auto opened = open_regular_file(path, status);
  if (!opened) return tl::unexpected(opened.error());
  const Descriptor file(*opened);
  std::uintmax_t size = static_cast<std::uintmax_t>(status.st_size);
  if (size <= most_bytes) begin(size);
  size = size <= most_bytes ? 0 : size;
  std::array<char, std::size_t{64} * 1024> block;
  while (size <= most_bytes) {
    if (interrupted()) return fail_at(path.string(), "not read to its end: interrupted");
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count == 0) return {};
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_failure(path, "cannot read the file");
    size += static_cast<std::uintmax_t>(count);
    if (size <= most_bytes) use(std::string_view(block.data(), static_cast<std::size_t>(count)));
  }
  return fail_at(path.string(), fmt::format("is larger than {} MiB, the most that such a file may "
                                            "have",
                                            most_bytes >> 20));
}

// OpenSSL fails here only without memory or with a broken installation, so the process aborts.
void must(int ok) {
  if (ok != 1) std::abort();
}

class Sha256 {
 public:
  Sha256() {
    static const EVP_MD* const fetched = EVP_MD_fetch(nullptr, "SHA256", nullptr);  // slow
    must(EVP_DigestInit_ex(context_.get(), fetched, nullptr));
  }

  void add(std::string_view bytes) {
    must(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
  }

  std::string hex() {
    std::array<unsigned char, 32> digest;
    must(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr));
    return fmt::format("{:02x}", fmt::join(digest, ""));
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_{EVP_MD_CTX_new(),
                                                                   EVP_MD_CTX_free};
};

// Returns a descriptor of stdout for the file, or -1 with errno. All that the process prints to
// stdout later goes to stderr, so that the file alone is written to stdout.
int take_stdout() {
  std::fflush(stdout);
  const int file = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (file >= 0 && ::dup2(STDERR_FILENO, STDOUT_FILENO) >= 0) return file;
  if (file >= 0) ::close(file);
  return -1;
}

}  // namespace

Result<int> open_regular_file(const fs::path& path) {
  struct stat status {};
  return open_regular_file(path, status);
}

Result<std::string> read_file(const fs::path& path, std::uintmax_t most_bytes) {
  std::string text;
  const auto done = for_each_block(
      path, most_bytes, [&](std::uintmax_t size) { text.reserve(size); },
      [&](std::string_view block) { text += block; });
  if (!done) return tl::unexpected(done.error());
  return text;
}

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.hex();
}

Result<std::string> sha256_of_file(const fs::path& path, std::uintmax_t most_bytes) {
  Sha256 hash;
  const auto done = for_each_block(
      path, most_bytes, [](std::uintmax_t) {}, [&](std::string_view block) { hash.add(block); });
  if (!done) return tl::unexpected(done.error());
  return hash.hex();
}

namespace {

// True if `path` must be written to directly: a terminal, pipe or device. Also any file named in
// /dev or /proc: /dev/stdout may lead to a regular file, and a rename would take that file away
// from its other writers.
bool is_written_in_place(const fs::path& path, const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return true;
  std::error_code ignored;
  const fs::path directory = fs::canonical(fs::absolute(path, ignored).parent_path(), ignored);
  return directory == "/dev" || directory.string().starts_with("/proc/");
}

std::string random_suffix() {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  std::string suffix;
  for (int i = 0; i < 6; ++i) suffix += letters[random() % letters.size()];
  return suffix;
}

constexpr mode_t new_file_mode = 0644;  // the umask applies, as for any new file

// Calls `create` with random names that contain `name` until one is free, at most 100 times. Stores
// the name in `temporary`. Returns the result of `create`, or -1 with errno.
template <typename Create>
int with_free_name(const std::string& name, std::string& temporary, Create create) {
  constexpr int attempts = 100;
  for (int i = 0; i < attempts; ++i) {
    temporary = fmt::format(".{}.{}", name, random_suffix());
    const int created = create(temporary.c_str());
    if (created >= 0 || errno != EEXIST) return created;
  }
  return -1;
}

// Gives a file without a name the name `name` in `folder`. Returns 0, or -1 with errno (EEXIST if
// the name is taken).
int link_into(int folder, int file, const char* name) {
  const std::string source = fmt::format("/proc/self/fd/{}", file);
  return ::linkat(AT_FDCWD, source.c_str(), folder, name, AT_SYMLINK_FOLLOW);
}

}  // namespace

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      folder_(std::exchange(other.folder_, -1)),
      name_(std::move(other.name_)),
      temporary_(std::exchange(other.temporary_, std::string())) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlinkat(folder_, temporary_.c_str(), 0);
  if (folder_ >= 0) ::close(folder_);
}

Result<AtomicFile> AtomicFile::open(const fs::path& path, Special special) {
  if (path.empty()) return AtomicFile("", -1);
  if (path == "-") {
    const int file = take_stdout();
    if (file < 0) return system_failure("stdout", "cannot write");
    return AtomicFile("stdout", file);
  }
  if (!path.has_filename()) return fail_at(path.string(), "not a file name; name a file");
  struct stat status;
  const bool replaces = special == Special::replaced;
  const bool exists = (replaces ? ::lstat : ::stat)(path.c_str(), &status) == 0;
  if (!exists && errno == ELOOP) return system_failure(path, "cannot create the file");
  if (exists && S_ISDIR(status.st_mode)) {
    return fail_at(path.string(), "is a directory; name a file");
  }
  if (replaces) return open_new(path, path);
  if (exists && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) {
    return system_failure(path, "cannot write the file");
  }
  if (exists && is_written_in_place(path, status)) return open_in_place(path);
  // A symbolic link stays, and the file that it points to is made or replaced, as by a shell.
  std::error_code failed;
  fs::path target = exists ? fs::canonical(path, failed) : behind_links(path);
  if (failed) return fail_at(path.string(), "cannot find the file: " + failed.message());
  return open_new(path, target);
}

Result<AtomicFile> AtomicFile::open_in_place(const fs::path& path) {
  constexpr int look_again_ms = 10, attempts = 500;
  // Without O_NONBLOCK, opening a pipe waits for a reader.
  constexpr int flags = O_WRONLY | O_APPEND | O_CLOEXEC;
  int file = ::open(path.c_str(), flags | O_NONBLOCK);
  for (int i = 0; file < 0 && errno == ENXIO && i < attempts && !interrupted(); ++i) {
    ::poll(nullptr, 0, look_again_ms);
    file = ::open(path.c_str(), flags | O_NONBLOCK);
  }
  if (file < 0) return system_failure(path, "cannot write the file");
  ::fcntl(file, F_SETFL, ::fcntl(file, F_GETFL) & ~O_NONBLOCK);
  return AtomicFile(path, file);
}

Result<AtomicFile> AtomicFile::open_new(const fs::path& path, const fs::path& target) {
  AtomicFile file(path, -1);
  file.name_ = target.filename().string();
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  file.folder_ = ::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (file.folder_ >= 0) file.descriptor_ = file.create();
  if (file.descriptor_ >= 0) return file;
  const int why = errno;
  std::error_code ignored;
  const bool is_link = fs::is_symlink(fs::symlink_status(path, ignored));
  errno = why;
  if (!is_link) return cannot_create(path);
  return system_failure(path, fmt::format("cannot create {}, to which it links", target.string()));
}

// Creates a new file in the folder. Returns its descriptor, or -1 with errno. The file has no name,
// so that it disappears when this process is killed. If the file system does not support this, the
// file gets a temporary name.
int AtomicFile::create() {
  const int nameless = ::openat(folder_, ".", O_WRONLY | O_TMPFILE | O_CLOEXEC, new_file_mode);
  if (nameless >= 0) return nameless;
  return with_free_name(name_, temporary_, [&](const char* name) {
    return ::openat(folder_, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, new_file_mode);
  });
}

// Gives the file its name. Returns 0, or -1 with errno. If there is no old file, a nameless file
// gets the name directly. Otherwise it gets a temporary name, and is then renamed. A kill between
// these steps leaves the temporary file.
int AtomicFile::give_name() {
  if (temporary_.empty()) {
    if (link_into(folder_, descriptor_, name_.c_str()) == 0) return 0;
    const int named = with_free_name(
        name_, temporary_, [&](const char* name) { return link_into(folder_, descriptor_, name); });
    if (named != 0) {
      temporary_.clear();
      return -1;
    }
  }
  if (::renameat(folder_, temporary_.c_str(), folder_, name_.c_str()) != 0) return -1;
  temporary_.clear();
  return 0;
}

Result<void> AtomicFile::write(std::string_view bytes) {
  if (descriptor_ < 0) return {};
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_failure(path_, "cannot write the file");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return {};
}

Result<void> AtomicFile::commit() {
  if (descriptor_ < 0) return {};
  // Pipes and terminals cannot be flushed to disk.
  const bool in_place = folder_ < 0;
  if (!in_place && ::fsync(descriptor_) != 0) {
    return system_failure(path_, "cannot write the file");
  }
  if (!in_place && give_name() != 0) return system_failure(path_, "cannot replace the file");
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    return system_failure(path_, "cannot write the file");
  }
  return {};
}

Result<void> AtomicFile::commit(std::string_view bytes) {
  if (auto written = write(bytes); !written) return written;
  return commit();
}

Result<void> write_file(const std::filesystem::path& path, std::string_view bytes,
                        AtomicFile::Special special) {
  auto file = AtomicFile::open(path, special);
  if (!file) return tl::unexpected(file.error());
  return file->commit(bytes);
}

}  // namespace attest
