#include "harness/sweep/merge_shards.hpp"

#include <cstddef>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "harness/core/file.hpp"

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

Result<FolderByShard> find_shards(const std::vector<fs::path>& folders,
                                  const SweepIdentity& whole) {
  FolderByShard by_shard;
  std::size_t count = 0;
  for (const fs::path& folder : folders) {
    if (auto added = add_folder(folder, whole, count, by_shard); !added) {
      return tl::unexpected(added.error());
    }
  }
  for (std::size_t index = 1; index <= count; ++index) {
    if (by_shard.contains(index)) continue;
    const std::size_t missing = count - by_shard.size();
    return fail(fmt::format("missing: the folder of shard {}{}", Shard{index, count}.to_string(),
                            missing == 1 ? "" : fmt::format(" and {} more", missing - 1)));
  }
  return by_shard;
}

}  // namespace

SampleRange range_of(const Shard& shard, std::uint64_t samples) {
  return {samples * (shard.index - 1) / shard.count, samples * shard.index / shard.count};
}

Result<void> merge_shards(const std::vector<fs::path>& folders, const SweepIdentity& whole,
                          const SampleColumns& columns, std::uint64_t samples,
                          const fs::path& out) {
  const auto by_shard = find_shards(folders, whole);
  if (!by_shard) return tl::unexpected(by_shard.error());
  if (auto claimed = claim_folder(out, whole); !claimed) return claimed;
  auto table = AtomicFile::open(out / sample_file);
  if (!table) return tl::unexpected(table.error());
  if (auto written = table->write(columns.header()); !written) return written;
  for (const auto& [index, folder] : *by_shard) {
    const fs::path file = folder / sample_file;
    const SampleRange range = range_of({index, by_shard->size()}, samples);
    if (auto complete = read_samples(file, columns, range); !complete) {
      return tl::unexpected(complete.error());
    }
    const auto text = read_file(file, std::numeric_limits<std::uintmax_t>::max());
    if (!text) return tl::unexpected(text.error());
    const std::string_view rows = std::string_view(*text).substr(columns.header().size());
    if (auto written = table->write(rows); !written) return written;
  }
  return table->commit();
}

}  // namespace attest
