// Is what a port answered what the golden says? Strict on length, timestamps, publication flags and
// non-finite values; bits at the exact level, a tolerance a channel at the numeric level.
//
// Only outputs that the golden recorded are compared, each tick with the same tick: rates are never
// compared with each other, nothing is interpolated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/compare/tilt.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// One value that is not what it should be.
struct Deviation {
  std::size_t tick = 0;  // 0 is the first step
  std::uint64_t timestamp_us = 0;
  std::size_t channel = 0;  // index into channels()
  double got = 0;
  double want = 0;
  std::int64_t ulp = 0;  // distance in float32 steps; 0 where that means nothing (flags, NaN)
  double tolerance = 0;  // allowed |got - want|; 0 at the exact level
};

// How near a passing channel came to failing: tolerance / |got - want|, 1 is the edge. Infinite
// when nothing but the sign of a zero differed; there is none when every value agreed to the bit.
struct Headroom {
  double ratio = 0;
  std::size_t tick = 0;
  std::size_t channel = 0;
};

struct Comparison {
  std::size_t ticks = 0;  // compared
  std::size_t deviating_ticks = 0;
  std::optional<Deviation> first;    // lowest tick, then the order of channels()
  std::optional<Headroom> tightest;  // numeric level, among the values within tolerance
  std::string mismatch;              // what makes the traces incomparable; empty if nothing
  std::string event;  // at the events level: what happens otherwise, at the first deviation
  bool got_non_finite = false;  // a NaN or Inf where none belongs, at any tick

  bool agrees() const { return !first && mismatch.empty(); }
};

Comparison compare(const Trace& got, const Trace& want, const Tolerances& tolerances);

// The first NaN or Inf of `got` in a channel in which `want` has neither, at none of its ticks. For
// a flight, of whose ticks the golden has some.
std::optional<Deviation> first_non_finite(const Trace& got, const Trace& want);

// The same tick by tick, for traces that are not in memory. At the events level only whether the
// traces can be compared at all.
class TickComparer {
 public:
  // What the two have recorded. REQUIRES: the tolerances outlive this.
  TickComparer(const ChannelSet& got, const ChannelSet& want, const Tolerances& tolerances);

  // The next tick of both; `changes` are the parameters that `want` sets at it.
  void add(const Sample& got, const Sample& want, std::span<const ParameterChange> changes);

  // How long both were in all: the longer one's rest is not added.
  Comparison finish(std::size_t got_ticks, std::size_t want_ticks);

 private:
  bool channel_agrees(std::size_t channel, const Sample& got, const Sample& want);
  double tolerance_at(std::size_t channel, const attest_inputs& in, float got, float want) const;
  void note(std::size_t channel, const Sample& got, const Sample& want, std::int64_t ulp,
            double tolerance);
  void note_headroom(std::size_t channel, double difference, double tolerance);

  const Tolerances& tolerances_;
  std::vector<std::size_t> chosen_;  // channels that both have and that are compared
  std::string not_recorded_;         // what is wrong with the channels
  std::size_t tick_ = 0;             // the next
  attest_inputs setpoint_{};         // as of the last attitude setpoint
  AttitudeGain gain_;
  Comparison result_;
};

// Index of the first tick whose inputs (in/..., parameters in force and timestamp, by bits) differ;
// empty when all agree.
std::optional<std::size_t> first_input_difference(const Trace& a, const Trace& b);

}  // namespace attest
