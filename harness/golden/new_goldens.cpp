#include "harness/golden/new_goldens.hpp"

#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "harness/core/suite_files.hpp"
#include "harness/core/version.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// Removes a file of this bless, and the two folders above it that it made. remove() keeps a folder
// that is not empty.
void remove_with_empty_folders(const fs::path& file) {
  std::error_code ignored;
  fs::remove(file, ignored);
  fs::remove(file.parent_path(), ignored);
  fs::remove(file.parent_path().parent_path(), ignored);
}

Result<void> move_to_place(const fs::path& golden) {
  std::error_code error;
  fs::rename(new_golden_file(golden), golden, error);
  if (!error) return {};
  return fail_at(golden.string(), fmt::format("cannot be replaced: {}", error.message()));
}

// The places in a folder of the golden root that have a new file next to them.
std::vector<fs::path> places_of_new_files(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> places;
  for (const auto& group : fs::directory_iterator(folder, error)) {
    if (!group.is_directory(error)) continue;
    for (const auto& file : fs::directory_iterator(group.path(), error)) {
      const fs::path place = fs::path(file.path()).replace_extension();
      if (file.path().extension() == ".new" && place.extension() == ".csv") places.push_back(place);
    }
  }
  return places;
}

// Those with other columns are stale, and cannot be in the same file.
void add_golden(const std::string& profile, const std::string& golden, GoldensByProfile& goldens) {
  std::erase_if(goldens, [&](const auto& one) { return !have_same_columns(one.second, golden); });
  goldens.insert_or_assign(profile, golden);
}

}  // namespace

std::string Making::own_reference() { return fmt::format("attest {}", version); }

NewGoldens::~NewGoldens() {
  if (origins_written_) return;
  for (const fs::path& file : files_) remove_with_empty_folders(new_golden_file(file));
}

// The origins that will be written.
Result<GoldenOrigins*> NewGoldens::origins_of(const std::string& profile) {
  const auto known = origins_.find(profile);
  if (known != origins_.end()) return &known->second;
  const auto& old = goldens_.origins_of(profile);
  if (!old) return tl::unexpected(old.error());
  return &origins_.emplace(profile, *old).first->second;
}

Result<GoldensByProfile> NewGoldens::goldens_of(const std::string& key) {
  GoldensByProfile goldens;
  const fs::path place = golden_file(goldens_.root(), key);
  for (const fs::path& file : {place, new_golden_file(place)}) {
    const auto text = read_suite_file(file);
    if (!text) continue;  // a run reports a file that is missing
    for (const auto& [profile, golden] : goldens_in(*text)) {
      const auto origins = origins_of(profile);
      if (!origins) return tl::unexpected(origins.error());
      const auto origin = (*origins)->find(key);
      if (origin == (*origins)->end() || origin->second.sha256 != sha256(golden)) continue;
      add_golden(profile, golden, goldens);
    }
  }
  return goldens;
}

Result<void> NewGoldens::remove(const std::string& profile, const std::string& key) {
  const auto origins = origins_of(profile);
  if (!origins) return tl::unexpected(origins.error());
  (*origins)->erase(key);
  ++changes_;
  const auto others = goldens_of(key);
  if (!others) return tl::unexpected(others.error());
  const fs::path place = golden_file(goldens_.root(), key);
  if (!others->empty()) {
    files_.insert(place);
    return write_file(new_golden_file(place), joined(*others), AtomicFile::Special::replaced);
  }
  std::error_code ignored;
  if (files_.erase(place) > 0) fs::remove(new_golden_file(place), ignored);
  removed_.insert(place);
  return {};
}

Result<void> NewGoldens::add(const Case& the_case, const MadeGolden& made, const Making& making) {
  if (!can_share(the_case.profile)) {
    return fail_at(
        the_case.file.string(),
        fmt::format("a golden cannot be of the profile `{}`: its file separates profiles "
                    "by spaces and commas; rename the profile",
                    the_case.profile));
  }
  const auto origins = origins_of(the_case.profile);
  if (!origins) return tl::unexpected(origins.error());
  const std::string key = key_of(the_case);
  auto goldens = goldens_of(key);
  if (!goldens) return tl::unexpected(goldens.error());
  const std::string golden = golden_text(made.traces);
  add_golden(the_case.profile, golden, *goldens);
  const fs::path file = golden_file(goldens_.root(), key);
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) {
    return fail_at(file.parent_path().string(), fmt::format("cannot be made: {}", error.message()));
  }
  files_.insert(file);
  ++changes_;
  GoldenOrigin origin{sha256(golden), the_case.sha256, making.reference, compiler(), making.reason};
  origin.inputs = made.inputs;
  origin.models = made.models;
  (**origins)[key] = std::move(origin);
  return write_file(new_golden_file(file), joined(*goldens), AtomicFile::Special::replaced);
}

Result<void> NewGoldens::put_in_place() {
  const Goldens now(goldens_.root());
  for (const auto& [profile, origins] : origins_) {
    const auto& current = now.origins_of(profile);
    if (!current) return tl::unexpected(current.error());
    if (*current == *goldens_.origins_of(profile)) continue;
    return fail_at(origins_file(goldens_.root(), profile).string(),
                   "was changed while the new goldens were made; bless again");
  }
  for (const auto& [profile, origins] : origins_) {
    if (origins == *goldens_.origins_of(profile)) continue;
    const fs::path file = origins_file(goldens_.root(), profile);
    std::error_code ignored;  // write_file() reports a folder that is missing
    fs::create_directories(file.parent_path(), ignored);
    const auto written = write_file(file, to_text(origins), AtomicFile::Special::replaced);
    if (!written) return written;
    origins_written_ = true;
  }
  for (const fs::path& file : files_) {
    if (auto moved = move_to_place(file); !moved) return moved;
  }
  for (const fs::path& file : removed_) remove_with_empty_folders(file);
  return {};
}

Result<void> finish_killed_bless(const fs::path& golden_root) {
  const Goldens blessed(golden_root);
  NewGoldens none(blessed);
  std::error_code error;
  for (const auto& folder : fs::directory_iterator(golden_root, error)) {
    if (!folder.is_directory(error) || folder.path().filename() == "recorded") continue;
    for (const fs::path& place : places_of_new_files(folder.path())) {
      const auto key = place.lexically_relative(golden_root).replace_extension().string();
      const auto goldens = none.goldens_of(key);
      if (!goldens) return tl::unexpected(goldens.error());
      std::error_code ignored;
      if (goldens->empty() && !fs::is_regular_file(place, ignored)) continue;
      if (!goldens->empty()) {
        auto written = write_file(place, joined(*goldens), AtomicFile::Special::replaced);
        if (!written) return written;
      }
      fs::remove(new_golden_file(place), ignored);
    }
  }
  if (error) return fail_at(golden_root.string(), "cannot be read: " + error.message());
  return {};
}

}  // namespace attest
