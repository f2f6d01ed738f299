// The samples of an output topic of a log, and the steps that published them (flight_log.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/unit_log.hpp"

namespace attest::ulog {

class PairedOutput {
 public:
  // REQUIRES: `log` outlives this, `series` is an output topic of it.
  PairedOutput(const ModuleContents& log, const LogSeries& series, LogRules rules);

  // Pairs the samples that were logged before the first step, or from a step until the next one.
  // `step`: the inputs of that step; null before the first step. Call it for each step in turn.
  void pair_until(std::size_t next_tick, const Sample* step);

  // Of the samples that were paired so far.
  const LoggedOutput& logged() const { return logged_; }

  // Adds the outputs of the tick. A tick that does not publish has the values of the tick before,
  // as the ABI requires.
  void add_to(std::size_t tick, const Sample& before, Sample& sample) const;

 private:
  void pair(std::size_t row, const Sample* step);
  bool is_of_others(const Sample* step) const;
  std::optional<std::size_t> tick_of(std::size_t row) const;
  std::optional<std::size_t> tick_sampled_at(std::uint64_t time) const;

  const LogSeries& series_;
  const LogSeries& steps_;
  Module module_;
  LogRules rules_;
  const Channel& published_;
  bool has_sample_times_;  // every step has a timestamp_sample; these do not decrease
  std::size_t next_row_ = 0;
  std::vector<std::uint32_t> rows_;  // of each tick, counted from 1; 0: the tick has no output
  LoggedOutput logged_;
};

}  // namespace attest::ulog
