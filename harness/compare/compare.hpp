// Is what a port answered what the golden says? Strict on length, timestamps, publication flags and
// non-finite values; bits at the exact level, a tolerance a channel at the numeric level.
//
// Only outputs that the golden recorded are compared, each tick with the same tick: rates are never
// compared with each other, nothing is interpolated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

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
  bool got_non_finite = false;  // the first deviation is a NaN or Inf where none belongs

  bool agrees() const { return !first && mismatch.empty(); }
};

Comparison compare(const Trace& got, const Trace& want, const Tolerances& tolerances);

// Index of the first tick whose inputs (in/..., parameters in force and timestamp, by bits) differ;
// empty when all agree.
std::optional<std::size_t> first_input_difference(const Trace& a, const Trace& b);

}  // namespace attest
