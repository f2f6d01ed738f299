#include "harness/golden/new_goldens.hpp"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "harness/core/version.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// remove() keeps a folder that is not empty.
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

// The goldens that have a new file next to them.
Result<std::vector<fs::path>> places_of_new_files(const fs::path& golden_root) {
  std::error_code error;
  std::vector<fs::path> places;
  for (fs::recursive_directory_iterator it(golden_root, error), end; it != end && !error;
       it.increment(error)) {
    if (it->path().extension() != ".new") continue;
    places.push_back(fs::path(it->path()).replace_extension());
  }
  if (!error) return places;
  return fail_at(golden_root.string(), fmt::format("cannot be read: {}", error.message()));
}

bool is_expected(const fs::path& golden, const fs::path& golden_root, const Goldens& goldens) {
  const fs::path in_root = golden.lexically_relative(golden_root);
  const auto& origins = goldens.origins_of(in_root.begin()->string());
  if (!origins) return false;
  const std::string key = golden.parent_path().filename().string() + "/" + golden.stem().string();
  const auto origin = origins->find(key);
  return origin != origins->end() &&
         sha256_of_file(new_golden_file(golden)) == origin->second.sha256;
}

}  // namespace

std::string Making::own_reference() { return fmt::format("attest {}", version); }

NewGoldens::~NewGoldens() {
  if (has_origins_) return;
  for (const fs::path& file : files_) remove_with_empty_folders(new_golden_file(file));
}

Result<void> NewGoldens::add(const Case& the_case, const MadeGolden& made, const Making& making) {
  if (!origins_.contains(the_case.profile)) {
    const auto& old = goldens_.origins_of(the_case.profile);
    if (!old) return tl::unexpected(old.error());
    origins_[the_case.profile] = *old;
  }
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
  for (const fs::path& model : made.vehicle_files) {
    auto of_model = sha256_of_file(model);
    if (!of_model) return tl::unexpected(of_model.error());
    origin.models[model.filename().string()] = *std::move(of_model);
  }
  origins_[the_case.profile][the_case.group + "/" + the_case.name] = std::move(origin);
  return {};
}

Result<void> NewGoldens::put_in_place() {
  for (const auto& [profile, origins] : origins_) {
    const auto written = write_file(origins_file(goldens_.root(), profile), to_text(origins),
                                    AtomicFile::Special::replaced);
    if (!written) return written;
    has_origins_ = true;
  }
  for (const fs::path& file : files_) {
    if (auto moved = move_to_place(file); !moved) return moved;
  }
  return {};
}

Result<void> finish_killed_bless(const fs::path& golden_root) {
  const auto places = places_of_new_files(golden_root);
  if (!places) return tl::unexpected(places.error());
  const Goldens goldens(golden_root);
  for (const fs::path& golden : *places) {
    if (!is_expected(golden, golden_root, goldens)) {
      remove_with_empty_folders(new_golden_file(golden));
    } else if (auto moved = move_to_place(golden); !moved) {
      return moved;
    }
  }
  return {};
}

}  // namespace attest
