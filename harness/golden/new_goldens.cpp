#include "harness/golden/new_goldens.hpp"

#include <system_error>

#include <fmt/format.h>

#include "harness/core/version.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// Removes a file of this bless, and the folders of group and profile that it made. remove() keeps a
// folder that is not empty.
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

// The goldens of a profile that have a new file next to them.
std::vector<fs::path> places_of_new_files(const fs::path& profile) {
  std::error_code error;
  std::vector<fs::path> places;
  for (const auto& group : fs::directory_iterator(profile, error)) {
    if (!group.is_directory(error)) continue;
    for (const auto& file : fs::directory_iterator(group.path(), error)) {
      const fs::path place = fs::path(file.path()).replace_extension();
      if (file.path().extension() == ".new" && place.extension() == ".csv") places.push_back(place);
    }
  }
  return places;
}

Result<void> finish(const fs::path& golden, const GoldenOrigins& origins) {
  const auto origin =
      origins.find(golden.parent_path().filename().string() + "/" + golden.stem().string());
  const fs::path pending = new_golden_file(golden);
  if (origin != origins.end() && sha256_of_file(pending) == origin->second.sha256) {
    return move_to_place(golden);
  }
  std::error_code ignored;
  if (fs::is_regular_file(golden, ignored)) fs::remove(pending, ignored);
  return {};
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

Result<void> NewGoldens::remove(const std::string& profile, const std::string& key) {
  const auto origins = origins_of(profile);
  if (!origins) return tl::unexpected(origins.error());
  (*origins)->erase(key);
  removed_.push_back(goldens_.root() / profile / (key + ".csv"));
  return {};
}

Result<void> NewGoldens::add(const Case& the_case, const MadeGolden& made, const Making& making) {
  const auto origins = origins_of(the_case.profile);
  if (!origins) return tl::unexpected(origins.error());
  const fs::path file = golden_file(goldens_.root(), the_case);
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) {
    return fail_at(file.parent_path().string(), fmt::format("cannot be made: {}", error.message()));
  }
  files_.push_back(file);
  const fs::path written = new_golden_file(file);
  if (auto done = write_golden(written, made.traces); !done) return done;
  const auto hash = sha256_of_file(written);
  if (!hash) return tl::unexpected(hash.error());
  GoldenOrigin origin{*hash, the_case.sha256, making.reference, compiler(), making.reason};
  origin.inputs = made.inputs;
  origin.models = made.models;
  (**origins)[key_of(the_case)] = std::move(origin);
  return {};
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
    const auto written = write_file(origins_file(goldens_.root(), profile), to_text(origins),
                                    AtomicFile::Special::replaced);
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
  const Goldens goldens(golden_root);
  std::error_code error;
  for (const auto& profile : fs::directory_iterator(golden_root, error)) {
    if (!profile.is_directory(error) || profile.path().filename() == "recorded") continue;
    const auto places = places_of_new_files(profile.path());
    if (places.empty()) continue;
    const auto& origins = goldens.origins_of(profile.path().filename().string());
    if (!origins) return tl::unexpected(origins.error());
    for (const fs::path& golden : places) {
      if (auto finished = finish(golden, *origins); !finished) return finished;
    }
  }
  if (error) return fail_at(golden_root.string(), "cannot be read: " + error.message());
  return {};
}

}  // namespace attest
