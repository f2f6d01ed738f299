// SampleTable: opens, continues and finishes a table.
#include <algorithm>
#include <array>
#include <cerrno>
#include <random>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/core/file.hpp"
#include "harness/core/file_lock.hpp"
#include "harness/sweep/sample_table.hpp"
#include "harness/sweep/table_extent.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

constexpr mode_t table_mode = 0644;  // less the umask

Result<void> write_all(int descriptor, std::string_view bytes, const fs::path& file) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return tl::unexpected(table_error(file, "cannot be written"));
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

// Where the file system has no locks, each process has an unfinished table of its own.
int open_unlocked(fs::path& part) {
  part += fmt::format("-{:08x}", std::random_device()());
  return ::open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, table_mode);
}

bool is_without_locks(int error) {
  return error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP;
}

// An unfinished or finished table, from which this one can be continued.
struct Source {
  fs::path file;
  TableExtent extent;
};

// The table with the most rows among `file` and its unfinished tables; `part` if none has more rows
// than it. An unfinished table may end with wrong lines, because the blocks that a dying machine
// writes reach the disk in any order.
Result<Source> longest(const fs::path& file, const fs::path& part, const SampleColumns& columns,
                       const SampleRange& range) {
  Source best{part, {}};
  std::error_code failed;
  if (fs::exists(file, failed)) {
    const auto extent = extent_of(file, columns, range, WrongLine::is_error);
    if (!extent) return tl::unexpected(extent.error());
    best = {file, *extent};
  }
  for (const fs::path& one : parts_of(file)) {
    const auto extent = extent_of(one, columns, range, WrongLine::ends_table);
    if (!extent) continue;  // removed by its machine
    const bool is_longer = extent->rows > best.extent.rows;
    if (is_longer || (one == part && extent->rows == best.extent.rows)) best = {one, *extent};
  }
  return best;
}

Result<void> copy_from(const Source& source, int descriptor, const fs::path& part) {
  const auto from = open_regular_file(source.file);
  if (!from) return tl::unexpected(from.error());
  bool copied = ::ftruncate(descriptor, 0) == 0;
  off_t offset = 0;
  while (copied && offset < static_cast<off_t>(source.extent.bytes)) {
    const auto left = source.extent.bytes - static_cast<std::uint64_t>(offset);
    copied = ::sendfile(descriptor, *from, &offset, left) > 0;
  }
  ::close(*from);
  if (copied) return {};
  return tl::unexpected(table_error(part, "cannot be written"));
}

// Makes `part` the unfinished table with the valid rows of the source, or with the header only, and
// seeks to its end.
Result<void> begin_part(const Source& source, const SampleColumns& columns, int descriptor,
                        const fs::path& part) {
  if (source.file != part) {
    if (auto copied = copy_from(source, descriptor, part); !copied) return copied;
  }
  if (::ftruncate(descriptor, static_cast<off_t>(source.extent.bytes)) != 0 ||
      ::lseek(descriptor, 0, SEEK_END) < 0) {
    return tl::unexpected(table_error(part, "cannot be continued"));
  }
  return source.extent.bytes > 0 ? Result<void>() : write_all(descriptor, columns.header(), part);
}

// A name of this machine: its host name, and the beginning of the id of its last boot. Two machines
// must not have the same name, because they do not see each other's locks. The boot id alone is not
// enough: copies of a virtual machine may share it.
std::string this_machine() {
  constexpr std::size_t enough = 8;
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const auto boot = read_file("/proc/sys/kernel/random/boot_id").value_or("unknown");
  return fmt::format("{}-{}", host.data(), boot.substr(0, enough));
}

}  // namespace

std::string part_prefix(const fs::path& file) { return file.filename().string() + ".part-"; }

std::vector<fs::path> parts_of(const fs::path& file) {
  std::vector<fs::path> parts;
  std::error_code failed;
  for (fs::directory_iterator it(file.parent_path(), failed), end; it != end && !failed;
       it.increment(failed)) {
    if (it->path().filename().string().starts_with(part_prefix(file))) parts.push_back(it->path());
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

Result<std::optional<SampleTable>> SampleTable::open(const fs::path& file,
                                                     const SampleColumns& columns,
                                                     const SampleRange& range,
                                                     const OnRow& on_row) {
  return open_on(this_machine(), file, columns, range, on_row);
}

Result<std::optional<SampleTable>> SampleTable::open_on(const std::string& machine,
                                                        const fs::path& file,
                                                        const SampleColumns& columns,
                                                        const SampleRange& range,
                                                        const OnRow& on_row) {
  fs::path part = file.parent_path() / (part_prefix(file) + machine);
  int descriptor = open_locked(part);
  if (descriptor < 0 && errno == EWOULDBLOCK) return std::nullopt;
  if (descriptor < 0 && is_without_locks(errno)) descriptor = open_unlocked(part);
  if (descriptor < 0) return tl::unexpected(table_error(part, "cannot be opened"));
  SampleTable table(file, part, descriptor, range.begin);
  const auto source = longest(file, part, columns, range);  // `part` is locked and cannot grow
  if (!source) return tl::unexpected(source.error());
  table.next_ += source->extent.rows;
  table.is_complete_ =
      source->file == file && source->extent.rows == range.size() && !source->extent.is_cut;
  std::error_code failed;
  if (table.is_complete_) {
    ::unlink(part.c_str());
  } else if (source->file != part && !fs::exists(source->file, failed)) {
    return std::nullopt;  // another process has just finished the table and removed the source
  } else if (auto begun = begin_part(*source, columns, descriptor, part); !begun) {
    return tl::unexpected(begun.error());
  }
  const auto given =
      extent_of(table.is_complete_ ? file : part, columns, range, WrongLine::is_error, on_row);
  if (!given) return tl::unexpected(given.error());
  return table;
}

SampleTable::SampleTable(SampleTable&& other) noexcept
    : file_(std::move(other.file_)),
      part_(std::move(other.part_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      next_(other.next_),
      is_complete_(other.is_complete_) {}

SampleTable::~SampleTable() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> SampleTable::append(std::string_view line) {
  ++next_;
  return write_all(descriptor_, line, part_);
}

Result<void> SampleTable::finish() {
  if (is_complete_) return {};
  if (::fsync(descriptor_) != 0) return tl::unexpected(table_error(part_, "cannot be written"));
  std::error_code failed;
  // ENOENT: another machine has made the same table, and has removed this part.
  const bool is_made =
      ::rename(part_.c_str(), file_.c_str()) == 0 || (errno == ENOENT && fs::exists(file_, failed));
  if (!is_made) return tl::unexpected(table_error(file_, "cannot be written"));
  is_complete_ = true;
  for (const fs::path& other : parts_of(file_)) ::unlink(other.c_str());
  return {};
}

}  // namespace attest
