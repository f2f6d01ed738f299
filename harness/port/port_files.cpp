#include "harness/port/port_files.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/port/port.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;

bool is_same(const timespec& a, const timespec& b) {
  return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec;
}

// Whether the file was not touched between the two. A process cannot set the time of the last
// change of status (ctime).
bool is_untouched(const struct stat& before, const struct stat& now) {
  return before.st_dev == now.st_dev && before.st_ino == now.st_ino &&
         before.st_size == now.st_size && is_same(before.st_mtim, now.st_mtim) &&
         is_same(before.st_ctim, now.st_ctim);
}

}  // namespace

Result<PortFiles::File> PortFiles::read_file(const fs::path& path) {
  File file{path, {}, {}};
  if (::stat(path.c_str(), &file.status) != 0) file.status = {};  // hashing gives the error
  auto hash = sha256_of_file(path, most_bytes);
  if (!hash) return tl::unexpected(hash.error());
  file.sha256 = *std::move(hash);
  return file;
}

Result<PortFiles> PortFiles::read(const std::string& specification,
                                  const std::vector<std::string>& named) {
  std::vector<std::string> paths = files_of(specification);
  const std::vector<std::string> own = paths;
  std::copy_if(named.begin(), named.end(), std::back_inserter(paths), [&](const auto& path) {
    return std::none_of(own.begin(), own.end(), [&](const std::string& known) {
      std::error_code ignored;
      return fs::equivalent(known, path, ignored);
    });
  });
  PortFiles all;
  for (const std::string& path : paths) {
    auto file = read_file(path);
    if (!file) return tl::unexpected(file.error());
    all.files_.push_back(*std::move(file));
  }
  return all;
}

std::string PortFiles::sha256() const {
  if (files_.empty()) return "";
  if (files_.size() == 1) return files_.front().sha256;
  std::string lines;
  for (const File& file : files_) lines += file.sha256 + '\n';
  return attest::sha256(lines);
}

Result<void> PortFiles::check(Untouched untouched) const {
  for (const File& file : files_) {
    struct stat now {};
    const bool exists = ::stat(file.path.c_str(), &now) == 0;
    if (exists && untouched == Untouched::skipped && is_untouched(file.status, now)) continue;
    const auto hash = exists ? sha256_of_file(file.path, most_bytes) : fail("");
    if (hash && *hash == file.sha256) continue;
    if (!hash && interrupted()) return {};  // not read to its end; the run is not complete anyway
    return fail_at(file.path.string(),
                   "the port changed during the run; run again when its build has ended");
  }
  return {};
}

}  // namespace attest
