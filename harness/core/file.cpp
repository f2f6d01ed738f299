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
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/core/interrupt.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// Names the limit that caused the error, because the system's message does not.
std::string_view limit_of(int error) {
  if (error == EFBIG) return " (`ulimit -f` limits the size of files)";
  if (error == EMFILE) return " (`ulimit -n` limits how many are open)";
  return "";
}

// REQUIRES: a system call has just failed and set errno.
tl::unexpected<Error> system_failure(const fs::path& path, std::string_view what) {
  const int error = errno;
  const std::string reason = std::generic_category().message(error);
  return fail_at(path.string(), fmt::format("{}: {}{}", what, reason, limit_of(error)));
}

std::string_view kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
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
  if (file < 0) return system_failure(path, "cannot open the file");
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
  Sha256() { must(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr)); }

  void add(std::string_view bytes) {
    must(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
  }

  std::string hex() {
    std::array<unsigned char, 32> digest;
    must(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr));
    std::string text;
    for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
    return text;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_{EVP_MD_CTX_new()};
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

fs::path behind_links(fs::path path) {
  constexpr int most = 40;  // as Linux
  fs::path target = path;
  std::error_code failed;
  for (int i = 0; i < most; ++i) {
    if (!fs::is_symlink(fs::symlink_status(target, failed))) return target;
    target = target.parent_path() / fs::read_symlink(target, failed);
  }
  return path;
}

std::string path_from_here(const fs::path& path) {
  std::error_code failed;
  const fs::path absolute = fs::weakly_canonical(fs::absolute(path, failed), failed);
  if (failed) return path.string();
  const fs::path relative = absolute.lexically_relative(fs::current_path(failed));
  const bool is_below = !failed && !relative.empty() && *relative.begin() != "..";
  return is_below ? relative.string() : absolute.string();
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

// Most paths are in normal form already, and std::filesystem takes 5 us to find that out.
std::string normal_form(const fs::path& path) {
  const std::string& text = path.native();
  const bool is_normal = !text.starts_with('.') && text.find("/.") == std::string::npos &&
                         text.find("//") == std::string::npos;
  return is_normal ? text : path.lexically_normal().native();
}

}  // namespace

void FileHashes::add(const fs::path& path, std::string sha256) {
  hashes_[normal_form(path)] = std::move(sha256);
}

bool FileHashes::has(const fs::path& path) const { return hashes_.contains(normal_form(path)); }

Result<void> FileHashes::check(const fs::path& path, const std::string& sha256) const {
  const auto known = hashes_.find(normal_form(path));
  if (known != hashes_.end() && known->second == sha256) return {};
  return fail_at(path.string(), "changed during the run; run again while no program writes to it");
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

// Calls `create` with random names in the folder of `target` until one is free, at most 100 times.
// Stores the name in `temporary`. Returns the result of `create`, or -1 with errno.
template <typename Create>
int with_free_name(const fs::path& target, fs::path& temporary, Create create) {
  constexpr int attempts = 100;
  for (int i = 0; i < attempts; ++i) {
    temporary = target;
    temporary.replace_filename(fmt::format(".{}.{}", target.filename().string(), random_suffix()));
    const int created = create(temporary);
    if (created >= 0 || errno != EEXIST) return created;
  }
  return -1;
}

// Creates a new file in the folder of `target`. Returns its descriptor, or -1 with errno. The file
// has no name, so that it disappears when this process is killed. If the file system does not
// support this, the file gets a name, which is stored in `temporary`.
int create_in_folder_of(const fs::path& target, fs::path& temporary) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const int nameless = ::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, new_file_mode);
  if (nameless >= 0) return nameless;
  return with_free_name(target, temporary, [](const fs::path& name) {
    return ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, new_file_mode);
  });
}

// Gives a file without a name the name `name`. Returns 0, or -1 with errno (EEXIST if the name is
// taken).
int give_name(int file, const fs::path& name) {
  const std::string source = fmt::format("/proc/self/fd/{}", file);
  return ::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
}

// Gives a file without a name a random name in the folder of `target`, and stores it in
// `temporary`. Returns 0, or -1 with errno.
int name_in_folder_of(int file, const fs::path& target, fs::path& temporary) {
  return with_free_name(target, temporary,
                        [&](const fs::path& name) { return give_name(file, name); });
}

}  // namespace

AtomicFile::AtomicFile(fs::path path, fs::path target, fs::path temporary, int descriptor)
    : path_(std::move(path)),
      target_(std::move(target)),
      temporary_(std::move(temporary)),
      descriptor_(descriptor) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::exchange(other.target_, fs::path())),
      temporary_(std::exchange(other.temporary_, fs::path())),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<AtomicFile> AtomicFile::open(const fs::path& path) {
  if (path == "-") {
    const int file = take_stdout();
    return file < 0 ? Result<AtomicFile>(system_failure("stdout", "cannot write"))
                    : AtomicFile("stdout", "", "", file);
  }
  if (!path.has_filename()) return fail_at(path.string(), "not a file name; name a file");
  struct stat status;
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (!exists && errno == ELOOP) return system_failure(path, "cannot create the file");
  if (exists && S_ISDIR(status.st_mode)) {
    return fail_at(path.string(), "is a directory; name a file");
  }
  if (exists && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) {
    return system_failure(path, "cannot write the file");
  }
  if (exists && is_written_in_place(path, status)) {
    const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (file < 0) return system_failure(path, "cannot write the file");
    return AtomicFile(path, "", "", file);
  }
  // A symbolic link stays, and the file that it points to is made or replaced, as by a shell.
  std::error_code failed;
  fs::path target = exists ? fs::canonical(path, failed) : behind_links(path);
  if (failed) return fail_at(path.string(), "cannot find the file: " + failed.message());
  fs::path temporary;
  const int file = create_in_folder_of(target, temporary);
  if (file < 0 && !exists && target != path) {
    return system_failure(path,
                          fmt::format("cannot create {}, to which it links", target.string()));
  }
  if (file < 0) return system_failure(path, "cannot create the file");
  return AtomicFile(path, std::move(target), std::move(temporary), file);
}

Result<void> AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_failure(path_, "cannot write the file");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return {};
}

Result<void> AtomicFile::commit() {
  const bool in_place = target_.empty();
  // Pipes and terminals cannot be flushed to disk.
  if (!in_place && ::fsync(descriptor_) != 0) {
    return system_failure(path_, "cannot write the file");
  }
  const bool has_no_name = !in_place && temporary_.empty();
  // If there is no old file, a nameless file gets the name `target_` directly. Otherwise it gets a
  // temporary name, and is then renamed. A kill between these steps leaves the temporary file.
  const bool is_in_place = in_place || (has_no_name && give_name(descriptor_, target_) == 0);
  if (has_no_name && !is_in_place && name_in_folder_of(descriptor_, target_, temporary_) != 0) {
    temporary_.clear();
    return system_failure(path_, "cannot replace the file");
  }
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    return system_failure(path_, "cannot write the file");
  }
  if (is_in_place) return {};
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    return system_failure(path_, "cannot replace the file");
  }
  temporary_.clear();
  return {};
}

Result<void> write_file(const std::filesystem::path& path, std::string_view bytes) {
  if (path.empty()) return {};
  auto file = AtomicFile::open(path);
  if (!file) return tl::unexpected(file.error());
  if (auto written = file->write(bytes); !written) return written;
  return file->commit();
}

}  // namespace attest
