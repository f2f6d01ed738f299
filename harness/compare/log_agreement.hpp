// How well a port's outputs agree with those of a flight log. A log is not a golden: it lacks
// samples, so some of its outputs were computed from samples that it does not have.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/trace/trace.hpp"

namespace attest {

// A port agrees with a log if enough of its outputs are within the tolerance, and few are without
// an explanation.
struct LogLimits {
  double within = 1e-4;  // in the unit of the signal
  double least_part_within = 0.85;
  // In a real log of 69 s, 0.9% had no explanation. A third of these were in fast manoeuvres, where
  // the value between two logged samples is larger than at both. The others were barely beyond the
  // tolerance.
  double most_unexplained = 0.02;

  // How many must be within. Neighbours explain no deviation of a single step.
  double least_part(bool single_steps) const {
    return single_steps ? std::max(least_part_within, 1 - most_unexplained) : least_part_within;
  }
};

struct LoggedPair {
  std::size_t tick;
  std::uint64_t timestamp_us;
  double after_s;       // after tick 0
  std::size_t channel;  // index into channels()
  double got, logged;
};

// One topic. Its deviation at a tick is the largest of its fields. NaN agrees with NaN only.
struct TopicAgreement {
  std::string_view topic;
  std::string condition = {};        // which of its samples; empty: all
  std::string not_judged;            // why it is reported but not judged; empty: it is judged
  bool is_unlike_reference = false;  // it is not judged because the reference does not agree
  std::size_t left_out = 0;          // ticks whose logged output cannot be computed from the log
  std::size_t paired = 0;            // the other ticks with an output in the log
  std::size_t missing = 0;           // paired ticks at which the port did not publish
  // Ticks at which log and port have an output, and the port has NaN or infinity where the log has
  // a number. A tick that is left out counts too, if the reference is finite there. One is enough
  // for the port not to agree.
  std::size_t non_finite = 0;
  // Deviations at the paired ticks at which the port published. Nearest rank; 0 without such ticks.
  // With 65,536 such ticks or more, all but `largest` are rounded up by less than 0.1%.
  double median = 0, p90 = 0, p99 = 0, largest = 0;
  std::size_t within = 0;
  // Ticks that are not within, where log and port are, in every field that deviates, between the
  // reference's smallest and largest value at the tick and its two neighbours. The logged output
  // may then be that of a sample between these ticks, which the log lacks. The range is the
  // reference's, because a port with wild values would widen its own.
  std::size_t between_samples = 0;
  std::optional<LoggedPair> first_unexplained;
  // Ticks at which the reference agrees with the log, so the inputs are known, and the port is off
  // by more than ten times the tolerance or does not publish. One is enough for the port not to
  // agree.
  std::size_t mistakes = 0;
  std::optional<LoggedPair> worst;  // the first with the largest deviation, of those with numbers

  std::size_t unexplained() const { return paired - within - between_samples; }
  double part_within() const;  // of the paired ticks, 0..1
  double part_unexplained() const;
  bool agrees(const LogLimits& limits) const;
};

// Takes the traces part by part. Its memory does not grow with their number.
class LogAgreement {
 public:
  // Whether a deviation can be explained by the two neighbours of a tick. Not if the ticks do not
  // follow each other.
  enum class Neighbours : std::uint8_t { explain, do_not_explain };

  // `logged`: the channels of the log.
  LogAgreement(const ChannelSet& logged, const LogLimits& limits,
               Neighbours neighbours = Neighbours::explain);
  LogAgreement(LogAgreement&&) noexcept;
  LogAgreement& operator=(LogAgreement&&) noexcept;
  ~LogAgreement();

  // The next ticks. `reference`: the reference's outputs for the inputs of the log. `got`, `logged`
  // and `reference` have the same ticks. `leaves_out`: the ticks to leave out, in every topic; if
  // empty, no tick is left out.
  void add(const Trace& got, const Trace& logged, const Trace& reference,
           const std::vector<bool>& leaves_out = {});

  // The topics that the log has, in the order of the channels. REQUIRES: add() is not called again.
  std::vector<TopicAgreement> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace attest
