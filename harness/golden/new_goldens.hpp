// Goldens that bless writes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/golden/golden.hpp"

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

  // Errors: the origins of the old goldens were edited; a file cannot be read or written.
  Result<void> add(const Case& the_case, const MadeGolden& made, const Making& making);

  // Removes a golden without a case, when the others are put in place. Errors: as for add().
  Result<void> remove(const std::string& profile, const std::string& key);

  // Writes the origins of each profile, then moves the goldens to their places. Golden::open()
  // finds a complete golden at each moment, even if the process is killed: the old one until the
  // origins are written, then the new one. Errors: a file cannot be written or moved; the origins
  // have changed since they were read.
  Result<void> put_in_place();

  // The number of goldens that change.
  std::size_t size() const { return files_.size() + removed_.size(); }

 private:
  Result<GoldenOrigins*> origins_of(const std::string& profile);

  const Goldens& goldens_;
  std::map<std::string, GoldenOrigins> origins_;  // by profile, with the old ones
  std::vector<std::filesystem::path> files_;      // places of the new goldens
  std::vector<std::filesystem::path> removed_;
  bool origins_written_ = false;  // of a profile; the new files then stay
};

// Ends what a killed bless has begun. Moves a new golden to its place if the origins have its hash.
// Otherwise the old golden is in force, and the new one is removed; without an old one it stays,
// and the next bless of its case replaces it. Errors: the origins cannot be read; a file cannot be
// moved.
Result<void> finish_killed_bless(const std::filesystem::path& golden_root);

}  // namespace attest
