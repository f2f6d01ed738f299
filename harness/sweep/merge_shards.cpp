#include "harness/sweep/merge_shards.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/file.hpp"
#include "harness/sweep/table_extent.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

using FolderByShard = std::map<std::size_t, fs::path>;

Result<void> add_folder(const fs::path& folder, const SweepIdentity& whole, std::size_t& count,
                        FolderByShard& by_shard) {
  const auto found = read_identity(folder);
  if (!found) return tl::unexpected(found.error());
  if (const std::string other = difference(*found, whole); !other.empty()) {
    return fail_at(folder.string(), "is of another sweep: " + other);
  }
  const auto shard = Shard::parse(found->shard);
  if (!shard) return fail_at(folder.string(), shard.error().message);
  if (count != 0 && shard->count != count) {
    return fail_at(folder.string(), fmt::format("is shard {}, but {} is one of {}", found->shard,
                                                by_shard.begin()->second.string(), count));
  }
  count = shard->count;
  const auto [other, is_new] = by_shard.emplace(shard->index, folder);
  if (is_new) return {};
  return fail_at(folder.string(), fmt::format("is shard {}, and so is {}; name each shard once",
                                              found->shard, other->second.string()));
}

std::vector<fs::path> folders_of_shards(const fs::path& folder) {
  std::error_code failed;
  std::vector<fs::path> folders;
  if (fs::exists(folder / identity_file, failed)) return {folder};
  for (fs::directory_iterator it(folder, failed), end; it != end && !failed; it.increment(failed)) {
    std::error_code ignored;
    if (fs::exists(it->path() / identity_file, ignored)) folders.push_back(it->path());
  }
  if (folders.empty()) return {folder};
  std::sort(folders.begin(), folders.end());
  return folders;
}

Result<FolderByShard> find_shards(const std::vector<fs::path>& given, const SweepIdentity& whole,
                                  std::size_t& count) {
  FolderByShard by_shard;
  for (const fs::path& one : given) {
    for (const fs::path& folder : folders_of_shards(one)) {
      if (auto added = add_folder(folder, whole, count, by_shard); !added) {
        return tl::unexpected(added.error());
      }
    }
  }
  return by_shard;
}

struct Incomplete {
  std::vector<std::size_t> missing;  // shards without a folder
  std::vector<std::size_t> shards;   // shards that lack samples
  std::string example;               // "part2 has 9 of 10 samples"
};

Error error_of(const Incomplete& found, std::size_t count) {
  std::vector<std::string> parts;
  if (!found.missing.empty()) {
    parts.push_back(
        fmt::format("missing: the folders of shards {} of {}", ranges_of(found.missing), count));
  }
  if (!found.shards.empty()) {
    parts.push_back(fmt::format("incomplete: shards {} of {} ({})", ranges_of(found.shards), count,
                                found.example));
  }
  return {
      fmt::format("{}; run these shards again with the same --out, which flies only what is "
                  "missing",
                  fmt::join(parts, "; "))};
}

// The rows of a shard, with their line ends; empty if the shard is incomplete. `there` becomes the
// number of its rows.
Result<std::optional<std::string>> rows_of(const fs::path& folder, const SampleColumns& columns,
                                           const SampleRange& range, std::uint64_t& there) {
  const fs::path file = folder / sample_file;
  std::error_code failed;
  if (!fs::exists(file, failed)) {
    there = 0;
    for (const fs::path& part : parts_of(file)) {
      const auto extent = extent_of(part, columns, range, WrongLine::ends_table);
      if (extent) there = std::max(there, extent->rows);
    }
    return std::nullopt;
  }
  const auto extent = extent_of(file, columns, range, WrongLine::is_error);
  if (!extent) return tl::unexpected(extent.error());
  there = extent->rows;
  if (extent->is_cut || there != range.size()) return std::nullopt;
  auto text = read_file(file, extent->bytes);
  if (!text) return tl::unexpected(text.error());
  return text->substr(columns.header().size());
}

}  // namespace

SampleRange range_of(const Shard& shard, std::uint64_t samples) {
  return {samples * (shard.index - 1) / shard.count, samples * shard.index / shard.count};
}

std::string ranges_of(const std::vector<std::size_t>& indices) {
  std::vector<std::string> ranges;
  for (std::size_t i = 0, next; i < indices.size(); i = next) {
    for (next = i + 1; next < indices.size() && indices[next] == indices[next - 1] + 1;) ++next;
    ranges.push_back(next == i + 1 ? fmt::to_string(indices[i])
                                   : fmt::format("{}-{}", indices[i], indices[next - 1]));
  }
  return fmt::format("{}", fmt::join(ranges, ","));
}

Result<void> merge_shards(const std::vector<fs::path>& folders, const SweepIdentity& whole,
                          const SampleColumns& columns, std::uint64_t samples,
                          const fs::path& out) {
  std::size_t count = 0;
  const auto by_shard = find_shards(folders, whole, count);
  if (!by_shard) return tl::unexpected(by_shard.error());
  if (auto claimed = claim_folder(out, whole); !claimed) return claimed;
  auto table = AtomicFile::open(out / sample_file);
  if (!table) return tl::unexpected(table.error());
  if (auto written = table->write(columns.header()); !written) return written;
  Incomplete incomplete;
  for (std::size_t index = 1; index <= count; ++index) {
    if (!by_shard->contains(index)) {
      incomplete.missing.push_back(index);
      continue;
    }
    const fs::path& folder = by_shard->at(index);
    const SampleRange range = range_of({index, count}, samples);
    std::uint64_t there = 0;
    const auto rows = rows_of(folder, columns, range, there);
    if (!rows) return tl::unexpected(rows.error());
    if (!*rows) {
      incomplete.shards.push_back(index);
      if (incomplete.example.empty()) {
        incomplete.example =
            fmt::format("{} has {} of {} samples", folder.string(), there, range.size());
      }
    } else if (auto written = table->write(**rows); !written) {
      return written;
    }
  }
  if (!incomplete.missing.empty() || !incomplete.shards.empty()) {
    return tl::unexpected(error_of(incomplete, count));
  }
  return table->commit();
}

}  // namespace attest
