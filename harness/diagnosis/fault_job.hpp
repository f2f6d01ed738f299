// Runs one fault of the catalogue on the suite until a case catches it, on the log of a flight, or
// in a hunt. This measures what the suite, the log and the hunt can show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/casefile/select.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/golden/golden.hpp"
#include "harness/process/job.hpp"
#include "harness/verify/evaluate_log.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The first case that caught a fault.
struct FaultCatch {
  Verdict verdict = Verdict::pass;  // pass: no case caught it
  std::string by;                   // id of the vector (VectorResult::id)
  std::optional<std::size_t> tick;  // the first tick with a deviation
  bool agrees_with_log = false;     // if LogFaultJob finds it out

  bool is_caught() const { return fails_a_run(verdict); }
};

template <>
struct Codec<FaultCatch> {
  static std::string encode(const Result<FaultCatch>& result);
  static Result<FaultCatch> decode(const std::string& text);
};

// The hunt of a fault.
struct HuntCatch {
  // As steps_before_failure().
  std::optional<std::size_t> steps_before;

  // Whether a hunt of so many steps finds the fault.
  bool is_found_in(std::size_t steps) const { return steps_before && *steps_before < steps; }
};

template <>
struct Codec<HuntCatch> {
  static std::string encode(const Result<HuntCatch>& result);
  static Result<HuntCatch> decode(const std::string& text);
};

class FaultJob final : public Job<FaultCatch> {
 public:
  // REQUIRES: each case is an open-loop case of `profile`; `cases` and `goldens` outlive this.
  FaultJob(const faults::Fault& fault, std::string profile, const std::vector<SelectedCase>& cases,
           const Goldens& goldens, std::optional<int> fraction_bits,
           std::optional<Level> level = {})
      : fault_(fault),
        profile_(std::move(profile)),
        cases_(cases),
        goldens_(goldens),
        fraction_bits_(fraction_bits),
        level_(level) {}

  std::size_t size() const override { return 1; }

  // First runs the cases of the fault's own group at 250 Hz, then at other rates; then all other
  // cases in the same way. All cases are judged at `level`, if it is set. Otherwise cases on a
  // threshold of the law (Case::exact_only) are judged at the exact level, and the others at the
  // numeric level. A fault of another law is not run.
  Result<FaultCatch> run(std::size_t task) override;

 private:
  const faults::Fault& fault_;
  std::string profile_;
  const std::vector<SelectedCase>& cases_;
  const Goldens& goldens_;
  std::optional<int> fraction_bits_;  // if set, the fault is judged as a port in fixed point
  std::optional<Level> level_;
};

// How the reference agrees with a log. Where it does not, the log shows no mistakes of a port.
struct ReferenceOnLog {
  // "rate unit: ...": a unit with which it does not agree, and one of which the log shows too
  // little.
  std::vector<std::string> deviations, not_judged;
  bool any_passes = false;  // of the units

  bool agrees() const { return deviations.empty(); }
};

// Judges as `attest replay` does. Errors: the log shows too little of each unit; those of
// evaluate_log().
Result<ReferenceOnLog> judge_reference(const FlightLog& log);

// Runs one fault on each unit of a log until a unit fails. `by` is then the title of the unit.
class LogFaultJob final : public Job<FaultCatch> {
 public:
  // `is_explanation`: also find out whether the fault agrees with the log as the reference should.
  // REQUIRES: `log` outlives this, and is read as a whole.
  LogFaultJob(const faults::Fault& fault, const FlightLog& log, bool is_explanation)
      : fault_(fault), log_(log), is_explanation_(is_explanation) {}

  std::size_t size() const override { return 1; }
  Result<FaultCatch> run(std::size_t task) override;

 private:
  const faults::Fault& fault_;
  const FlightLog& log_;
  bool is_explanation_;
};

// Hunts one fault in a profile: all its modules, which take turns, as `attest hunt --profile` does.
// A fault that is not detectable in the profile is not hunted.
class HuntFaultJob final : public Job<HuntCatch> {
 public:
  struct Options {
    std::size_t steps = 1;  // at least
    std::uint64_t seed = 1;
    Level level = Level::numeric;
  };
  HuntFaultJob(const faults::Fault& fault, std::string profile, Options options)
      : fault_(fault), profile_(std::move(profile)), options_(options) {}

  std::size_t size() const override { return 1; }
  Result<HuntCatch> run(std::size_t task) override;

 private:
  const faults::Fault& fault_;
  std::string profile_;
  Options options_;
};

}  // namespace attest
