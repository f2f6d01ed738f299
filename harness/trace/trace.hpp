// A recorded run: what the unit was given at each tick and what it answered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/trace/channels.hpp"

namespace attest {

// Parameters in force from a tick on. A change at tick 0 is made before the first step; one at a
// later tick belongs to a sample whose PARAMETER_UPDATE bit is set.
struct ParameterChange {
  std::size_t tick;
  std::string name;
  float value;

  friend bool operator==(const ParameterChange&, const ParameterChange&) = default;
};

// The changes of a trace as its ticks go by.
class PendingChanges {
 public:
  explicit PendingChanges(std::span<const ParameterChange> changes) : pending_(changes) {}

  // Those up to `tick` that no earlier call returned; valid as long as the trace is.
  std::span<const ParameterChange> take_until(std::size_t tick) {
    std::size_t count = 0;
    while (count < pending_.size() && pending_[count].tick <= tick) ++count;
    const auto due = pending_.first(count);
    pending_ = pending_.subspan(count);
    return due;
  }

 private:
  std::span<const ParameterChange> pending_;
};

// What is true of the vehicle at a tick, beside what the unit was told: for metrics and for people
// (plant_columns.hpp names its columns). Never compared. NED and FRD, SI units.
struct PlantSample {
  std::array<float, 3> position_m;    // of the centre of mass
  std::array<float, 3> velocity_m_s;  // of the centre of mass
  std::array<float, 4> q;             // body to world
  std::array<float, 3> rate_rad_s;    // of the body
  std::array<float, 8> motor;         // commands of the mixer, -1 stopped .. 1 full
  std::array<float, 8> rotor_rad_s;   // speeds
  float voltage_V;                    // of the battery; 0 without one
  std::uint8_t saturated;             // the mixer gave something up at this tick
};

// What a file of a trace must contain, beside timestamp.
enum class TraceNeed {
  inputs,             // every in/ channel: to feed a port
  outputs,            // at least one out/ channel: to compare
  inputs_and_outputs  // to replay
};

struct Trace {
  std::string source;                       // file or case, for messages
  std::vector<Sample> samples;              // one a tick, timestamps strictly increasing
  std::vector<ParameterChange> parameters;  // by tick, then in the order they are set
  ChannelSet present;                       // the channels that were recorded; the others are 0
  std::vector<PlantSample> plant;           // of a flown trace: one a sample; else empty
};

}  // namespace attest
