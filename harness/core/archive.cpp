#include "harness/core/archive.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <minizip/unzip.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/core/file.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

constexpr const char* remedy =
    "restore the archive, or install attest anew; --suite DIR names a suite in a folder";

// ---- the bytes of the archive, as minizip asks for them -----------------------------------------

class Bytes {
 public:
  explicit Bytes(const fs::path& path) : path_(fs::absolute(path)), name_(path) {}
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  ~Bytes() { release(); }

  // Opens the archive until release(). Errors: it is not the one that was opened first.
  Result<void> hold() {
    if (file_ >= 0) return {};
    file_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat now {};
    if (file_ < 0 || ::fstat(file_, &now) != 0) {
      const int reason = errno;
      close();
      return fail_at(name_.string(),
                     fmt::format("cannot open the file: {}", std::strerror(reason)));
    }
    if (first_.st_ino == 0) first_ = now;
    const bool same = now.st_ino == first_.st_ino && now.st_dev == first_.st_dev &&
                      now.st_size == first_.st_size &&
                      now.st_mtim.tv_sec == first_.st_mtim.tv_sec &&
                      now.st_mtim.tv_nsec == first_.st_mtim.tv_nsec;
    if (same) return {};
    close();
    return fail_at(name_.string(),
                   "changed during the run; run again while no program writes to it");
  }

  void release() {
    if (!stays_open_) close();
    // They may be of a neighbour, such as a golden.
    ::explicit_bzero(ahead_.data(), ahead_size_);
    ahead_size_ = 0;
  }

  void stay_open(bool stays) {
    stays_open_ = stays;
    if (!stays) release();
  }

  // Keeps the rest of the archive, which is the directory, because minizip reads it byte by byte.
  // Does not if the rest is larger than a directory may be.
  void keep_from(std::uint64_t begin) {
    const std::uint64_t rest = size() - std::min(begin, size());
    if (rest > most_text_bytes) return;
    kept_begin_ = begin;
    kept_.resize(rest);
    kept_.resize(read_from(begin, kept_.data(), kept_.size()));
  }

  // What minizip calls. `opaque` is this object, which is also its stream.
  zlib_filefunc64_def functions() {
    zlib_filefunc64_def functions{};
    functions.opaque = this;
    functions.zopen64_file = [](voidpf opaque, const void*, int) { return opaque; };
    functions.zread_file = [](voidpf opaque, voidpf, void* to, uLong count) -> uLong {
      auto& bytes = *static_cast<Bytes*>(opaque);
      if (count != 1 || bytes.at_ - bytes.kept_begin_ >= bytes.kept_.size()) {
        return bytes.read(static_cast<char*>(to), count);
      }
      // Most calls: a byte of the directory.
      *static_cast<char*>(to) = bytes.kept_[bytes.at_++ - bytes.kept_begin_];
      return 1;
    };
    functions.ztell64_file = [](voidpf opaque, voidpf) -> ZPOS64_T {
      return static_cast<Bytes*>(opaque)->at_;
    };
    functions.zseek64_file = [](voidpf opaque, voidpf, ZPOS64_T offset, int origin) -> long {
      auto& bytes = *static_cast<Bytes*>(opaque);
      if (origin == SEEK_CUR) offset += bytes.at_;
      if (origin == SEEK_END) offset += bytes.size();
      bytes.at_ = offset;
      return 0;
    };
    functions.zclose_file = [](voidpf, voidpf) { return 0; };
    functions.zerror_file = [](voidpf, voidpf) { return 0; };
    return functions;
  }

 private:
  void close() {
    if (file_ >= 0) ::close(std::exchange(file_, -1));
  }

  std::uint64_t size() const { return static_cast<std::uint64_t>(first_.st_size); }

  std::size_t read_from(std::uint64_t begin, char* to, std::size_t count) const {
    std::size_t done = 0;
    while (done < count) {
      const auto at = static_cast<off_t>(begin + done);
      const ssize_t got = ::pread(file_, to + done, count - done, at);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    return done;
  }

  // Whether `part`, which begins at `begin`, has the `count` bytes at at_; then copies them.
  bool copy_from(std::string_view part, std::uint64_t begin, char* to, std::size_t count) const {
    // A damaged archive may have any place in it, so at_ + count may be larger than 64 bits.
    if (at_ < begin || at_ - begin > part.size()) return false;
    const std::string_view from = part.substr(at_ - begin);
    if (count > from.size()) return false;
    std::copy_n(from.data(), count, to);
    return true;
  }

  bool copy_from_ahead(char* to, std::size_t count) const {
    return copy_from({ahead_.data(), ahead_size_}, ahead_begin_, to, count);
  }

  std::size_t read(char* to, std::size_t count) {
    if (!copy_from(kept_, kept_begin_, to, count) && !copy_from_ahead(to, count)) {
      if (count < ahead_.size()) {
        ahead_begin_ = at_;
        ahead_size_ = read_from(at_, ahead_.data(), ahead_.size());
        count = std::min(count, ahead_size_);
        copy_from_ahead(to, count);
      } else {
        count = read_from(at_, to, count);
      }
    }
    at_ += count;
    return count;
  }

  fs::path path_, name_;  // name_: in messages
  struct stat first_ {};
  int file_ = -1;
  bool stays_open_ = false;
  std::uint64_t at_ = 0;
  std::string kept_;
  std::uint64_t kept_begin_ = 0;
  std::array<char, 4096> ahead_{};  // more than most cases, and than the header of a file
  std::size_t ahead_size_ = 0;
  std::uint64_t ahead_begin_ = 0;
};

// ---- the list of the files ----------------------------------------------------------------------

struct Close {
  void operator()(void* zip) const { unzClose(zip); }
};
using Zip = std::unique_ptr<void, Close>;

struct Entry {
  unz64_file_pos place{};
  std::uint64_t size = 0;
};

// Whether the name leads to a place below the folder into which it is extracted.
bool leads_inside(const std::string& name) {
  const std::string parts = "/" + name + (name.ends_with('/') ? "" : "/");
  const auto has = [&](std::string_view text) { return parts.find(text) != std::string::npos; };
  return !has("//") && !has("/./") && !has("/../") && !has(std::string_view("\0", 1));
}

// The name of the current file of `zip`. Empty: it cannot be read.
std::string read_name(const Zip& zip, Entry& entry) {
  std::array<char, PATH_MAX> name;
  unz_file_info64 info{};
  const bool read = unzGetCurrentFileInfo64(zip.get(), &info, name.data(), name.size(), nullptr, 0,
                                            nullptr, 0) == UNZ_OK &&
                    unzGetFilePos64(zip.get(), &entry.place) == UNZ_OK;
  entry.size = info.uncompressed_size;
  if (!read || info.size_filename > name.size()) return "";
  return {name.data(), info.size_filename};
}

tl::unexpected<Error> damaged(const fs::path& file, std::string_view what) {
  return fail_at(file.string(), fmt::format("{}; {}", what, remedy));
}

}  // namespace

struct Archive::Contents {
  explicit Contents(const fs::path& path) : bytes(path) {}

  Result<void> read_names(const fs::path& path);
  Result<std::string> read(const Entry& entry, const fs::path& file);

  Bytes bytes;
  Zip zip;
  std::vector<std::string> names;
  std::vector<Entry> entries;  // of names
};

Result<void> Archive::Contents::read_names(const fs::path& path) {
  zlib_filefunc64_def functions = bytes.functions();
  zip.reset(unzOpen2_64("", &functions));
  unz_global_info64 all{};
  if (!zip || unzGetGlobalInfo64(zip.get(), &all) != UNZ_OK) {
    return damaged(path, "is no zip archive, or is damaged");
  }
  if (unzGoToFirstFile(zip.get()) == UNZ_OK) bytes.keep_from(unzGetOffset64(zip.get()));
  std::vector<std::pair<std::string, Entry>> found;
  found.reserve(std::min<std::size_t>(all.number_entry, 100'000));
  int more = unzGoToFirstFile(zip.get());
  for (; more == UNZ_OK; more = unzGoToNextFile(zip.get())) {
    Entry entry;
    std::string name = read_name(zip, entry);
    if (name.empty()) return damaged(path, "is damaged: the name of a file cannot be read");
    if (!leads_inside(name)) {
      return damaged(path, fmt::format("has a file outside of its folder: `{}`", name));
    }
    if (!name.ends_with('/')) found.emplace_back(std::move(name), entry);
  }
  if (more != UNZ_END_OF_LIST_OF_FILE && all.number_entry > 0) {
    return damaged(path, "is damaged: the list of its files ends early");
  }
  std::ranges::sort(
      found, {}, [](const auto& one) -> const auto& { return one.first; });
  for (auto& [name, entry] : found) {
    if (!names.empty() && names.back() == name) {
      return damaged(path, fmt::format("has two files `{}`", name));
    }
    names.push_back(std::move(name));
    entries.push_back(entry);
  }
  return {};
}

Result<std::string> Archive::Contents::read(const Entry& entry, const fs::path& file) {
  if (entry.size > most_text_bytes) {
    return fail_at(file.string(), fmt::format("is larger than {} MiB, the most that such a file "
                                              "may have",
                                              most_text_bytes >> 20));
  }
  const auto broken = [&] { return damaged(file, "is damaged in its archive"); };
  if (unzGoToFilePos64(zip.get(), &entry.place) != UNZ_OK) return broken();
  if (unzOpenCurrentFile(zip.get()) != UNZ_OK) return broken();
  std::string text(entry.size, '\0');
  const auto size = static_cast<unsigned>(text.size());
  const bool complete =
      static_cast<std::size_t>(unzReadCurrentFile(zip.get(), text.data(), size)) == text.size();
  // Compares the CRC, too.
  if (unzCloseCurrentFile(zip.get()) != UNZ_OK || !complete) return broken();
  return text;
}

Archive::Archive(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
Archive::Archive(Archive&&) noexcept = default;
Archive::~Archive() = default;

Result<Archive> Archive::open(const fs::path& path) {
  auto contents = std::make_unique<Contents>(path);
  if (auto held = contents->bytes.hold(); !held) return tl::unexpected(held.error());
  const auto read = contents->read_names(path);
  contents->bytes.release();
  if (!read) return tl::unexpected(read.error());
  return Archive(std::move(contents));
}

std::shared_ptr<const void> Archive::keep_open() const {
  contents_->bytes.stay_open(true);
  return {contents_.get(), [](Contents* contents) { contents->bytes.stay_open(false); }};
}

const std::vector<std::string>& Archive::names() const { return contents_->names; }

Result<std::string> Archive::read(const std::string& name, const fs::path& file) const {
  if (name.empty()) return fail_at(file.string(), "is an archive; name a file in it");
  const auto found = std::ranges::lower_bound(names(), name);
  if (found == names().end() || *found != name) {
    return fail_at(file.string(), "cannot open the file: No such file or directory");
  }
  if (auto held = contents_->bytes.hold(); !held) return tl::unexpected(held.error());
  auto text =
      contents_->read(contents_->entries[static_cast<std::size_t>(found - names().begin())], file);
  contents_->bytes.release();
  return text;
}

}  // namespace attest
