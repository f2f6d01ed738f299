// Searches inputs on which a port differs from the reference. A trial is a trace of some hundred
// ticks, made from the seed and its number. A round is a fixed number of trials. Between rounds the
// trials that reached something new in the reference are kept, in the order of their numbers, and
// later trials vary them. So the findings depend on the seed and the rounds, and not on the number
// of processes. A hunt can begin with inputs of cases: they are its first trials, and later trials
// vary them, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/diagnosis/hunt_findings.hpp"
#include "harness/port/profiles.hpp"

namespace attest {

// So far, at the end of a round.
struct HuntProgress {
  std::size_t trials = 0, steps = 0, failures = 0;
  HuntFeatures met;      // of all targets
  double deviation = 0;  // the largest of a trial that did not fail, in units of its tolerance
};

struct HuntOptions {
  std::vector<ModuleUnderTest> subjects;  // take turns
  Level level = Level::numeric;
  std::uint64_t seed = 1;
  std::vector<HuntInputs> first;        // tried first, whatever least_steps is
  std::size_t least_steps = 1'000'000;  // the hunt ends after the round that reaches them
  std::function<bool()> is_over = [] { return false; };  // asked after a round, too
  bool fail_fast = false;  // the hunt ends after the round of the first failing trial, too
  // At stop() the round is not counted; findings of the rounds before it are made.
  HuntWorkers workers;
  // Called after the last round. If stop() is still true, no findings are made.
  std::function<void()> on_end = [] {};
  std::function<void(const HuntProgress&)> on_round = [](const HuntProgress&) {};
  // Called after a round with the case of each trial that reached something new in the reference,
  // up to the tick that did, in the order of the trials. An error ends the hunt. May be empty.
  std::function<Result<void>(const std::string& profile, const std::string& toml)> on_new = {};
};

struct HuntRun {
  HuntProgress progress;
  std::vector<HuntFinding> findings;  // in the order in which they were found
  std::string ended_early;            // why; empty: by least_steps or is_over()
};

// A hunt ends when the port did not answer in time in five trials, each of which costs the time
// limit. REQUIRES: HostOptions::said. Errors: the port cannot be started, the reference fails, a
// case does not make its inputs, stop() after the last round.
Result<HuntRun> hunt(const HuntOptions& options, const HostOptions& host);

// Hunts up to the first failing trial, which is not shrunk. Returns the steps of the rounds before
// that trial's round: hunt() finds it if its least_steps are more. Empty: no trial failed.
// REQUIRES and errors: those of hunt().
Result<std::optional<std::size_t>> steps_before_failure(const HuntOptions& options,
                                                        const HostOptions& host);

// The modules of the profile that are in `of_port`.
std::vector<ModuleUnderTest> subjects_in(const ProfileInfo& profile, const ModuleSet& of_port);

}  // namespace attest
