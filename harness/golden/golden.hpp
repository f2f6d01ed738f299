// The golden traces of a case: golden/<profile>/<group>/<name>/<configuration>.csv and one
// provenance.toml, which records their origin. The golden of a flight keeps only some ticks
// (keyframes.hpp); its provenance has the horizon and the metrics. The golden of a long open-loop
// case keeps keyframes too (keeps_every_tick).
//
// A case file can have several profiles. The golden of the first profile is then the base: the
// goldens of the others hold only their differences from it. Goldens of keyframes have no base:
// another profile keeps other ticks, and in a flight the unit's inputs depend on its outputs.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/file.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/reference_flight.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {

// The golden of one case, open for reading.
class Golden {
 public:
  // `suite`: the hashes of the suite's files when the run began; null: not compared. Errors: the
  // golden is missing, was made from another version of the case file, or its provenance or that of
  // its base was edited, or has another hash in `suite`. The message names the remedy.
  static Result<Golden> open(const std::filesystem::path& golden_root, const Case& the_case,
                             const FileHashes* suite = nullptr);

  // Errors: no trace for that configuration, a broken CSV, bytes that differ from the blessed ones.
  // The bytes that are hashed are those that are parsed, also of the base: a file that is replaced
  // during the run is never judged against.
  Result<Trace> read(const RunConfiguration& configuration) const;

  // The rows, horizon and metrics of a flight. Errors: those of read(); a file from which the
  // vehicle was loaded is new or has changed since the golden was made; no horizon.
  Result<ReferenceFlight> read_flight(const RunConfiguration& configuration,
                                      const Vehicle& vehicle) const;

  const Provenance& provenance() const { return provenance_; }

 private:
  explicit Golden(std::filesystem::path folder) : folder_(std::move(folder)) {}

  Result<std::string> blessed_text(const std::filesystem::path& path,
                                   const std::string& blessed) const;

  std::filesystem::path folder_;
  Provenance provenance_;
  std::optional<Provenance> of_base_;
};

// The key of a metric in Provenance::metrics.
std::string metric_key(const RunConfiguration& configuration, const std::string& metric);

std::filesystem::path golden_folder(const std::filesystem::path& golden_root, const Case& the_case);

// Whether an open-loop golden of this number of ticks keeps them all. A longer one keeps keyframes,
// so that it fits into a repository.
bool keeps_every_tick(std::size_t ticks);

// Whether this is an open-loop case whose golden keeps keyframes at its fastest rate.
bool is_long(const Case& the_case);

// One trace of a new golden.
struct GoldenTrace {
  RunConfiguration configuration;
  Trace trace;
  bool is_whole = true;  // false: keyframes, of a flight or a long case
  std::optional<double> horizon_s = std::nullopt;
  std::map<std::string, double> metrics = {};
};

// The golden of a case's first profile: the base of the goldens of its other profiles.
struct GoldenBase {
  const std::vector<GoldenTrace>& traces;
  std::filesystem::path folder;  // of its files: in place, or still NewGolden::written()
};

// What the provenance of a new golden says about its making.
struct Making {
  std::string reason;
  std::string reference = own_reference();  // the controller whose outputs it has
  static std::string own_reference();       // "attest 0.1.0"
};

// A new golden, complete, written next to its place and not yet put there. REQUIRES: the caller
// holds the GoldenLock.
class NewGolden {
 public:
  // Writes `traces` (one for each of the case's configurations, in that order). `vehicle_files` are
  // the files that the flights depend on. `base`: null, or the golden of the first profile.
  static Result<NewGolden> write(const std::filesystem::path& golden_root, const Case& the_case,
                                 const std::vector<GoldenTrace>& traces,
                                 const std::vector<std::filesystem::path>& vehicle_files,
                                 const Making& making, const GoldenBase* base = nullptr);
  NewGolden(NewGolden&& other) noexcept;
  NewGolden& operator=(NewGolden&&) = delete;
  ~NewGolden();  // removes what is not in place: this golden, or the one it replaced

  // If there is an old golden, a complete golden exists at each moment, even if the process is
  // killed. It is in its place if the file system can exchange two folders; otherwise it is in its
  // place or in `*.old`.
  Result<void> put_in_place();

  const std::filesystem::path& written() const { return written_; }

 private:
  NewGolden(std::filesystem::path folder, std::filesystem::path written);

  std::filesystem::path folder_;
  std::filesystem::path written_;
};

}  // namespace attest
