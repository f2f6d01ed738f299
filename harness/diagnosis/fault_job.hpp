// Runs one fault of the catalogue on the suite until a case catches it. This measures the quality
// of the suite.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/casefile/select.hpp"
#include "harness/verify/verdict.hpp"
#include "harness/workers/job.hpp"

namespace attest {

// The first case that caught a fault.
struct FaultCatch {
  Verdict verdict = Verdict::pass;  // pass: no case caught it
  std::string by;                   // id of the case, with its rate
  std::optional<std::size_t> tick;  // that deviates first

  bool is_caught() const { return fails_a_run(verdict); }
};

template <>
struct Codec<FaultCatch> {
  static std::string encode(const Result<FaultCatch>& result);
  static Result<FaultCatch> decode(const std::string& text);
};

class FaultJob final : public Job<FaultCatch> {
 public:
  // REQUIRES: each case is in open loop and of `profile`; `cases` outlives this.
  FaultJob(const faults::Fault& fault, std::string profile, const std::vector<SelectedCase>& cases,
           std::filesystem::path golden_root, std::optional<int> fraction_bits)
      : fault_(fault),
        profile_(std::move(profile)),
        cases_(cases),
        golden_root_(std::move(golden_root)),
        fraction_bits_(fraction_bits) {}

  std::size_t size() const override { return 1; }

  // Cases of the fault's own group come first, at 250 Hz and then at other rates; then all other
  // cases in the same way. Cases on a threshold of the law (Case::exact_only) are judged at the
  // exact level, the others at the numeric one.
  Result<FaultCatch> run(std::size_t task) override;

 private:
  const faults::Fault& fault_;
  std::string profile_;
  const std::vector<SelectedCase>& cases_;
  std::filesystem::path golden_root_;
  std::optional<int> fraction_bits_;  // judged as a port with this number of them
};

}  // namespace attest
