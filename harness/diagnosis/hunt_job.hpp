// The work of a hunt for worker processes: the trials of a part of a round, and the shrinking of a
// trial that failed.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/diagnosis/hunt_generator.hpp"
#include "harness/diagnosis/hunt_trial.hpp"
#include "harness/diagnosis/similarity.hpp"
#include "harness/verify/port_job.hpp"

namespace attest {

// A target, and what its trials have reached.
struct HuntedTarget {
  HuntTarget target;
  std::vector<HuntInputs> first;  // of cases: the first trials, unchanged
  std::vector<HuntInputs> kept;   // that trials vary
  HuntFeatures met;
  double deviation = 0;  // the largest of a trial that did not fail

  // The inputs of the trial. `targets`: that take turns.
  HuntInputs trial(std::uint64_t seed, std::uint64_t number, std::size_t targets) const;
};

using HuntTrials = std::vector<HuntTrial>;

struct HuntWorkers {
  int processes = 1;
  // True: end soon.
  std::function<bool()> stop = [] { return false; };
};

// `is_last`, if set: jobs after the first one with such a result are left out. Errors: those of the
// jobs; stop().
template <typename R>
Result<std::vector<R>> results_of(const Jobs<R>& jobs, const HuntWorkers& workers,
                                  const HostOptions& host, bool (*is_last)(const R&) = nullptr) {
  JobOptions<R> options;
  options.fail_fast = is_last != nullptr;
  if (is_last != nullptr) options.fails = is_last;
  options.processes = workers.processes;
  options.in_process = host.in_process;
  options.stop = workers.stop;
  return all_results(jobs, options);
}

template <>
struct Codec<HuntTrials> {
  static std::string encode(const Result<HuntTrials>& result);
  static Result<HuntTrials> decode(const std::string& text);
};

// HuntTrial::meets has only what HuntedTarget::met has not. A trial in which the port does not
// answer in time is the last one; with `ends_at_failure`, so is each trial that fails.
class TrialJob final : public PortJob<HuntTrials> {
 public:
  // The trials from `first` on, of which each target has its turn. REQUIRES: `targets` outlives
  // this, and does not change while the job runs.
  TrialJob(std::span<const HuntedTarget> targets, std::uint64_t seed, std::uint64_t first,
           std::size_t count, HostOptions options, bool ends_at_failure = false)
      : PortJob(std::move(options)),
        targets_(targets),
        seed_(seed),
        first_(first),
        count_(count),
        ends_at_failure_(ends_at_failure) {}

  std::size_t size() const override { return 1; }
  Result<HuntTrials> run(std::size_t task) override;

 private:
  std::span<const HuntedTarget> targets_;
  std::uint64_t seed_, first_;
  std::size_t count_;
  bool ends_at_failure_;
};

// A failure as a case, before and after it was shrunk.
struct ShrunkCase {
  std::string whole, shrunk;  // texts of case files
  VectorResult of_whole, of_shrunk;
  bool needs_others = false;  // the trial does not fail in a process of its own: no cases
  // Of the port, at the last ticks of the shrunk trial up to its first deviation, at most
  // most_answers. Empty without a deviation.
  Outputs got = {};
};
inline constexpr std::size_t most_answers = 2000;

template <>
struct Codec<ShrunkCase> {
  static std::string encode(const Result<ShrunkCase>& result);
  static Result<ShrunkCase> decode(const std::string& text);
};

struct ShrunkTrial;

class ShrinkJob final : public PortJob<ShrunkCase> {
 public:
  // REQUIRES: `target` outlives this.
  ShrinkJob(const HuntTarget& target, HuntInputs inputs, HostOptions options)
      : PortJob(std::move(options)), target_(target), inputs_(std::move(inputs)) {}

  std::size_t size() const override { return 1; }
  Result<ShrunkCase> run(std::size_t task) override;

 private:
  Result<Outputs> answers_to(const ShrunkTrial& shrunk) const;

  const HuntTarget& target_;
  HuntInputs inputs_;
};

// The reasons of a case: `why` and `rates_why`.
struct HuntReasons {
  std::string why = "Found by attest hunt. Fill in the mistake or property that it tests.";
  std::string rates_why = "The port fails at this rate.";
};

// The text of a case with these inputs. Errors: the case does not make them; the reference fails.
Result<std::string> case_of(const HuntInputs& inputs, Level level, const HuntReasons& reasons = {});

}  // namespace attest
