// Goldens that bless writes.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/golden/golden.hpp"
#include "harness/golden/shared_golden.hpp"

namespace attest {

// The content of a new golden: the outputs of the reference for a case.
struct MadeGolden {
  std::vector<GoldenTrace> traces;  // one for each of the case's configurations, in that order
  std::map<std::string, std::string> models = {};  // GoldenOrigin::models
  std::map<std::string, std::string> inputs = {};  // GoldenOrigin::inputs
  std::string left_out = {};  // why there is no golden of this case; empty if there is one
};

// What the origin of a new golden says about its making.
struct Making {
  std::string reason;
  std::string reference = own_reference();  // the controller whose outputs it has
  static std::string own_reference();       // "attest 0.1.0"
};

// New goldens, complete, written next to the old ones and not yet put in place. REQUIRES: the
// caller holds the GoldenLock.
class NewGoldens {
 public:
  // `goldens`: the old ones; it outlives this.
  explicit NewGoldens(const Goldens& goldens) : goldens_(goldens) {}
  NewGoldens(NewGoldens&& other) noexcept = default;
  NewGoldens& operator=(NewGoldens&&) = delete;
  ~NewGoldens();  // removes what was not put in place

  // The goldens of other profiles in the same file stay. Those with other columns are removed,
  // because they are stale. Errors: the origins of the old goldens were edited; a file cannot be
  // written; the name of the profile cannot be in the file.
  Result<void> add(const Case& the_case, const MadeGolden& made, const Making& making);

  // Removes a golden without a case, when the others are put in place. Errors: as for add().
  Result<void> remove(const std::string& profile, const std::string& key);

  // Writes the origins of each profile, then moves the goldens to their places. Golden::open()
  // finds a complete golden at each moment, even if the process is killed: the old one until the
  // origins are written, then the new one. Errors: a file cannot be written or moved; the origins
  // have changed since they were read.
  Result<void> put_in_place();

  // The goldens of a file that are in force after put_in_place(), as far as they are added. Errors:
  // the origins of one of them were edited.
  Result<GoldensByProfile> goldens_of(const std::string& key);

  // The number of goldens that change, each of one profile.
  std::size_t size() const { return changes_; }

 private:
  Result<GoldenOrigins*> origins_of(const std::string& profile);

  const Goldens& goldens_;
  std::map<std::string, GoldenOrigins> origins_;  // by profile, with the old ones
  std::set<std::filesystem::path> files_;         // places of files with new goldens
  std::set<std::filesystem::path> removed_;       // files without goldens
  std::size_t changes_ = 0;
  bool origins_written_ = false;  // of a profile; the new files then stay
};

// Ends what a killed bless has begun. Moves the goldens of a new file whose hashes the origins have
// to the file at its place, and removes the new one. If no golden is in force, neither old nor new,
// and only the new file is there, it stays, and the next bless of its case replaces it. Errors: the
// origins cannot be read; a file cannot be written.
Result<void> finish_killed_bless(const std::filesystem::path& golden_root);

}  // namespace attest
