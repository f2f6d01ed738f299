// The goldens of a suite: golden/<folder>/<group>/<name>.csv has the expected outputs of the cases
// of a case file (shared_golden.hpp), and golden/<profile>/provenance.toml the origins of those of
// a profile (golden_origins.hpp).
// The golden of a flight, or of a long open-loop case, keeps only some ticks (keyframes.hpp).
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/file.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/golden_file.hpp"
#include "harness/golden/golden_origins.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

// The golden of one case, read and checked.
class Golden {
 public:
  Golden(std::filesystem::path file, GoldenOrigin origin, std::vector<GoldenTrace> traces);

  // Valid as long as this. Errors: no trace for that configuration.
  Result<const GoldenTrace*> trace(const RunConfiguration& configuration) const;

  // Errors: a file from which the vehicle was loaded is new or has changed since the golden was
  // made.
  Result<void> check_vehicle(const Vehicle& vehicle) const;

  // A port made it, so that attest cannot compute its outputs.
  bool is_of_port() const { return !origin_.inputs.empty(); }
  // Errors: the inputs are not those that the port had. REQUIRES: is_of_port().
  Result<void> check_inputs(const Trace& inputs, const RunConfiguration& configuration) const;

  const std::filesystem::path& file() const { return file_; }
  const GoldenOrigin& origin() const { return origin_; }
  const std::vector<GoldenTrace>& traces() const { return traces_; }

 private:
  std::filesystem::path file_;
  GoldenOrigin origin_;
  std::vector<GoldenTrace> traces_;
  std::map<std::string, std::size_t> trace_of_;  // label of a configuration -> index
};

// The goldens of a suite, for one thread. Reads the origins of a profile once.
class Goldens {
 public:
  // `suite`: the hashes of the suite's files when the run began; null: not compared.
  explicit Goldens(std::filesystem::path root, std::shared_ptr<const FileHashes> suite = nullptr)
      : root_(std::move(root)), suite_(std::move(suite)) {}

  // Errors: the golden is missing, was made from another version of the case, or was edited; the
  // origins were edited, or have another hash in `suite`. The message names the remedy. The bytes
  // that are hashed are those that are parsed: a file that is replaced during the run is never
  // judged against.
  Result<Golden> open(const Case& the_case) const;

  // Errors: those of the file with the origins. A profile without that file has none.
  const Result<GoldenOrigins>& origins_of(const std::string& profile) const;

  // Whether the case has a golden: one in its origins or in its file. If one of them is missing or
  // cannot be read, open() reports it.
  bool has(const Case& the_case) const;

  // The description of the port that made the goldens; of all such ports, after `; `, if a killed
  // bless has left several. Empty: they are those of attest's own reference. Reads the origins of
  // all profiles; those that cannot be read are left out, because a run of their cases reports it.
  std::string reference() const;

  // The keys in the origins of a profile that have no case: `keys` are those of its cases.
  std::vector<std::string> without_case(const std::string& profile,
                                        const std::set<std::string>& keys) const;

  const std::filesystem::path& root() const { return root_; }

 private:
  Result<GoldenOrigins> read_origins(const std::string& profile) const;

  std::filesystem::path root_;
  std::shared_ptr<const FileHashes> suite_;
  mutable std::map<std::string, Result<GoldenOrigins>> origins_;  // by profile
};

// The key of a case in GoldenOrigins: the path of its golden without `.csv`, which is that of its
// file without `.toml`: "px4-v1.16.0/attitude/roll" for each profile of the case.
std::string key_of(const Case& the_case);
using GoldenKeys = std::map<std::string, std::set<std::string>>;  // profile -> keys of its cases
// Case::id() of the case with this key.
std::string id_of(const std::string& profile, const std::string& key);

// Name of each file from which the vehicle was loaded -> SHA-256 of the bytes that were loaded.
std::map<std::string, std::string> hashes_of(const Vehicle& vehicle);

std::filesystem::path golden_file(const std::filesystem::path& golden_root, const std::string& key);

// The place of a new golden until it is in its own. If bless is killed after it has written the
// origins, a reader finds the golden here, and the next bless moves it to its place.
std::filesystem::path new_golden_file(const std::filesystem::path& golden);

// Whether an open-loop golden of this number of ticks keeps them all. A longer one keeps keyframes,
// so that it fits into a repository.
bool keeps_every_tick(std::size_t ticks);

// Whether this is an open-loop case whose golden keeps keyframes at its fastest rate.
bool is_long(const Case& the_case);

}  // namespace attest
