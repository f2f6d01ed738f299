// The golden traces of a case: golden/<profile>/<group>/<name>/<configuration>.csv and one
// provenance.toml, which says what they were made from. Of a flight some ticks are kept, and in the
// provenance its horizon and metrics; of a long open-loop case some ticks too (keeps_every_tick).
//
// Where a case file has several profiles, the goldens of the others hold what differs from that of
// the first, which is their base. Goldens that keep some ticks have none: in another profile other
// ticks are kept, and in a flight what the unit is given depends on its answers.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/branch_alternatives.hpp"
#include "harness/golden/reference_flight.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {

// The golden of one case, open for reading.
class Golden {
 public:
  // Errors: there is none, it was made from another version of the case file, or its provenance was
  // edited; the message names what mends it.
  static Result<Golden> open(const std::filesystem::path& golden_root, const Case& the_case);

  // Errors: no trace for that configuration, bytes that are not those that were blessed, a broken
  // CSV.
  Result<Trace> read(const RunConfiguration& configuration) const;

  // What it is on other branches; empty for a case without Case::either_branch. Errors: those of
  // read().
  Result<BranchAlternatives> read_branch_alternatives(const RunConfiguration& configuration) const;

  // The rows, horizon and metrics of a flight. Errors: those of read(), and a vehicle whose files
  // have changed since.
  Result<ReferenceFlight> read_flight(const RunConfiguration& configuration,
                                      const Vehicle& vehicle) const;

  const Provenance& provenance() const { return provenance_; }

 private:
  Golden(std::filesystem::path folder, Provenance provenance);

  Result<Trace> read_file(const std::string& name) const;
  Result<void> check_bytes(const std::filesystem::path& path, const std::string& blessed) const;

  std::filesystem::path folder_;
  Provenance provenance_;
};

// Of Provenance::metrics.
std::string metric_key(const RunConfiguration& configuration, const std::string& metric);

std::filesystem::path golden_folder(const std::filesystem::path& golden_root, const Case& the_case);

// Of a longer case the golden keeps some ticks, so that it fits into a repository.
bool keeps_every_tick(std::size_t ticks);

// An open-loop case whose golden keeps some ticks.
bool is_long(const Case& the_case);

// One trace of a golden to be.
struct GoldenTrace {
  RunConfiguration configuration;
  Trace trace;
  bool is_whole = true;  // false: some of its ticks, of a flight or a long case
  std::optional<double> horizon_s = std::nullopt;
  std::map<std::string, double> metrics = {};
  BranchAlternatives branch_alternatives = {};  // of a case with Case::either_branch
};

// The golden of a case's first profile, which that of another one rests on.
struct GoldenBase {
  const std::vector<GoldenTrace>& traces;
  std::filesystem::path folder;  // where its files are now, perhaps not yet in place
};

// A golden that has been written beside its place, complete, and not yet put there. For who holds
// the GoldenLock.
class NewGolden {
 public:
  // Writes `traces` (one for each of the case's configurations, in that order). `vehicle_files` are
  // those that the flights depend on. `base`: null, or the golden of the first profile as it is
  // written, or stands, in `base_folder`.
  static Result<NewGolden> write(const std::filesystem::path& golden_root, const Case& the_case,
                                 const std::vector<GoldenTrace>& traces,
                                 const std::vector<std::filesystem::path>& vehicle_files,
                                 const std::string& reason, const GoldenBase* base = nullptr);
  NewGolden(NewGolden&& other) noexcept;
  NewGolden& operator=(NewGolden&&) = delete;
  ~NewGolden();  // removes what does not stand in its place: this one, or the one it replaced

  // At each moment, a kill included, a complete golden is there: where the file system can exchange
  // two folders in its place, else there or in `*.old`.
  Result<void> put_in_place();

  const std::filesystem::path& written() const { return written_; }

 private:
  NewGolden(std::filesystem::path folder, std::filesystem::path written);

  std::filesystem::path folder_;
  std::filesystem::path written_;
};

}  // namespace attest
