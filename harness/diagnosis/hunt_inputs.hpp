// The inputs of a trial of `attest hunt`, in a form in which they can be varied and shrunk: each
// tick has only what is new at it. hunt_trace.hpp makes a trace from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/rate.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct HuntTick {
  // The fields of a topic count only if its bit in `updated` is set; a topic without a bit is new
  // at every tick. A time is relative, as in a case file (SCHEMA.md): the bits of an int64 [us]
  // since the tick, and of `armed_time` since the first tick.
  Sample sample;
  std::uint32_t periods = 1;  // since the last tick; more than one: ticks were left out
  std::uint32_t quiet = 0;    // further ticks after this one, at which no topic with a bit is new
};

struct HuntInputs {
  ModuleUnderTest subject;
  Rate rate = Rate::hz(250);
  std::uint64_t start_us = 5'000'000;  // timestamp of the first tick
  std::vector<HuntTick> ticks;
  std::vector<ParameterChange> parameters;  // sorted by tick: the index in `ticks`

  std::size_t steps() const;  // with the quiet ticks
};

// A topic of a module's inputs: its place in a Sample.
struct HuntTopic {
  std::string_view name;
  std::uint32_t bit;                   // in `updated`; 0: new at every tick
  std::size_t begin, size;             // [bytes]
  std::vector<const Channel*> fields;  // in column order
  std::vector<const Channel*> times;   // those of `fields` that are times
  bool is_new(const Sample& sample) const { return bit == 0 || (sample.in.updated & bit) != 0; }
  void copy(const Sample& from, Sample& to) const;  // all fields
  bool has_same(const Sample& one, const Sample& other) const;
};

// The topics of a module, without parameter_update. The result is valid as long as the program.
// Whether one of the subjects is this module in this profile.
bool contains(std::span<const ModuleUnderTest> subjects, const std::string& profile, Module module);

std::span<const HuntTopic> hunt_topics(Module module);

// The bit of parameter_update; 0 if the module has none.
std::uint32_t parameter_bit(Module module);

// Whether times of this field count from the first tick.
bool is_from_first_tick(const Channel& channel);

// A relative time of `sample` [us].
std::int64_t relative_us(const Channel& channel, const Sample& sample);
void set_relative_us(const Channel& channel, Sample& sample, std::int64_t time_us);

}  // namespace attest
