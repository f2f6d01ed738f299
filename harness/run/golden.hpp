// The golden traces of a case: golden/<profile>/<group>/<name>/<rate>hz.csv and one
// provenance.toml, which says what they were made from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {

// The golden of one case, open for reading.
class Golden {
 public:
  // Errors: there is none, or it was made from another version of the case file; the message names
  // the `attest bless` that mends it.
  static Result<Golden> open(const std::filesystem::path& golden_root, const Case& the_case);

  // Errors: no trace for that rate, bytes that are not those that were blessed, a broken CSV.
  Result<Trace> read(const Rate& rate) const;

  const Provenance& provenance() const { return provenance_; }

 private:
  Golden(std::filesystem::path folder, Provenance provenance);

  std::filesystem::path folder_;
  Provenance provenance_;
};

std::filesystem::path golden_folder(const std::filesystem::path& golden_root, const Case& the_case);

// A golden that has been written beside its place, complete, and not yet put there.
class NewGolden {
 public:
  // Writes `traces` (one for each of the case's rates, in that order).
  static Result<NewGolden> write(const std::filesystem::path& golden_root, const Case& the_case,
                                 const std::vector<Trace>& traces, const std::string& reason);
  NewGolden(NewGolden&& other) noexcept;
  NewGolden& operator=(NewGolden&&) = delete;
  ~NewGolden();  // removes what was not put in place

  Result<void> put_in_place();

 private:
  NewGolden(std::filesystem::path folder, std::filesystem::path written);

  std::filesystem::path folder_;
  std::filesystem::path written_;
};

}  // namespace attest
