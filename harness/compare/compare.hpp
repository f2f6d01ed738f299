// Compares a port's outputs with the golden. Length and timestamps must always agree. Publication
// flags and non-finite values must agree at the levels exact and numeric. The exact level compares
// bits; the numeric level has a tolerance per channel.
//
// Only outputs that the golden recorded are compared, each tick with the same tick, except at the
// events level, which also uses the neighbouring ticks. Traces of different rates are not compared,
// and values are not interpolated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/compare/allowed_deviation.hpp"
#include "harness/compare/input_difference.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/trace_parts.hpp"

namespace attest {

// One value that is outside its tolerance.
struct Deviation {
  std::size_t tick = 0;  // 0 is the first step
  std::uint64_t timestamp_us = 0;
  std::size_t channel = 0;  // index into channels()
  double got = 0;
  double want = 0;
  std::int64_t ulp = 0;  // distance in float32 steps; 0 for flags and NaN, and at the events level
  double tolerance = 0;  // allowed |got - want|; 0 at the levels exact and events
  // Of a first deviation: the stages that can contain the mistake (suspected_stages.hpp).
  StageSet stages = {};
};

// The stages of a first deviation; those of another one: the stage that writes the signal.
StageSet stages_of(const Deviation& deviation);
// The stage that a report counts: that of the signal, or else the first one.
Stage stage_of(const Deviation& deviation);

// How near a passing channel came to failing: ratio = tolerance / |got - want|; 1 is the limit.
// Infinite when only the sign of a zero differed.
struct Headroom {
  double ratio = 0;
  std::size_t tick = 0;
  std::size_t channel = 0;
};

// The largest finite |got - want| of a signal.
struct Largest {
  std::size_t channel = 0;
  double deviation = 0;
};

struct Comparison {
  std::size_t ticks = 0;  // that were compared
  std::size_t deviating_ticks = 0;
  std::optional<Deviation> first;  // lowest tick, then the first of outputs_by_stage()
  // The largest difference in units of its tolerance, or in ulp at the exact level, among finite
  // floats; the first of equal ones. Empty at the events level.
  std::optional<Deviation> worst;
  std::optional<Headroom> tightest;  // numeric level; empty if no passing value differs
  std::vector<Largest> largest;      // of each float that differs, at every level
  std::string mismatch;              // why the traces cannot be compared; empty if they can
  std::string event;                 // at the events level: the difference at the first deviation
  ChannelSet only_got;               // outputs that only `got` has: they are not compared
  bool got_non_finite = false;       // at any tick, a NaN or Inf where the golden is finite
  std::optional<InputDifference> inputs;  // the first one, of two TraceParts

  bool agrees() const { return !first && mismatch.empty(); }
};

Comparison compare(const Trace& got, const Trace& want, const Tolerances& tolerances);
// The traces are read part by part, in memory that does not grow with their length; whole at the
// events level, which looks ahead. Also compares their inputs. Errors: those of TraceParts.
Result<Comparison> compare(TraceParts& got, TraceParts& want, const Tolerances& tolerances);

// Combines the comparisons of two traces of one flight: takes the earlier first deviation, at equal
// times that of the earlier stage, and the larger worst one. REQUIRES: both were compared at the
// numeric level.
Comparison both(Comparison one, const Comparison& other);

// The first NaN or Inf of `got` in a channel that is finite at all ticks of `want`. For flights,
// whose golden keeps only some of the ticks.
std::optional<Deviation> first_non_finite(const Trace& got, const Trace& want);

// Compares tick by tick, for traces that are not in memory. At the events level it only finds out
// whether the traces can be compared.
class TickComparer {
 public:
  // `got` and `want`: the recorded channels of both. REQUIRES: the tolerances outlive this.
  TickComparer(const ChannelSet& got, const ChannelSet& want, const Tolerances& tolerances);

  // The next tick of both; `changes` are the parameters that `want` sets at it.
  void add(const Sample& got, const Sample& want, std::span<const ParameterChange> changes);
  // The next ticks of both: parts of equal length, or of the shorter length.
  void add(const Trace& got, const Trace& want);

  // Takes the lengths of both traces. REQUIRES: add() was called for each tick that both have.
  Comparison finish(std::size_t got_ticks, std::size_t want_ticks);

 private:
  bool channel_agrees(std::size_t channel, const Sample& got, const Sample& want);
  void note(const Deviation& deviation);
  void note_largest(const Sample& got, const Sample& want);
  void note_headroom(std::size_t channel, double difference, double tolerance);

  Level level_;
  ChannelSet compared_;              // outputs that both have
  std::vector<std::size_t> chosen_;  // the same, by stage
  std::vector<double> largest_;      // of the channels in chosen_
  // The message if outputs of `want` are missing in `got`, or `want` has no output; else empty.
  std::string not_recorded_;
  std::size_t tick_ = 0;  // the next one to add
  AllowedDeviation allowed_;
  Comparison result_;
};

}  // namespace attest
