// The samples of an output topic of a log, and the steps that published them (flight_log.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/unit_log.hpp"

namespace attest::ulog {

// The inputs of a step, and its outputs as far as they are found.
struct PairedStep {
  Sample sample;
  std::optional<std::uint64_t> sample_time;  // LogSeries::sample_time()
  std::uint64_t setpoint_us = 0;             // LoggedSetpoint::time_us
};

// The last steps, to which outputs can be paired.
using PairedSteps = Queue<PairedStep>;

class PairedOutput {
 public:
  // `has_sample_times`: that of the whole log's steps. REQUIRES: `series`, an output topic of
  // `module`, outlives this.
  PairedOutput(Module module, LogSeries& series, bool has_sample_times, LogRules rules);

  // Adds the outputs that were logged before `end` to their steps, and forgets them; without `end`,
  // all that were read. The last one of `steps` is the last that began before they were logged;
  // without steps, they were logged before the first one. REQUIRES: the series has all samples
  // before `end`.
  void pair_until(std::optional<std::uint64_t> end, PairedSteps& steps);

  // Of the samples that were paired so far.
  const LoggedOutput& logged() const { return logged_; }

  // A step that does not publish has the values of the step before, as the ABI requires.
  void repeat(const Sample& before, Sample& sample) const;

 private:
  void pair(std::size_t row, PairedSteps& steps);
  bool is_of_others(const PairedSteps& steps) const;
  PairedStep* step_of(std::size_t row, PairedSteps& steps) const;

  LogSeries& series_;
  Module module_;
  LogRules rules_;
  const Channel& published_;
  bool has_sample_times_;
  std::size_t next_row_ = 0;
  LoggedOutput logged_;
};

}  // namespace attest::ulog
