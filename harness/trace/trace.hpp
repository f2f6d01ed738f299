// A recorded run: the inputs and outputs of one module at each tick.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "harness/trace/channels.hpp"

namespace attest {

// A parameter that has a new value from a tick on. A change at tick 0 is made before the first
// step. A change at a later tick belongs to a sample whose PARAMETER_UPDATE bit is set.
struct ParameterChange {
  std::size_t tick;
  std::string name;
  float value;

  friend bool operator==(const ParameterChange&, const ParameterChange&) = default;
};

// Hands out the changes of a trace, tick by tick.
class PendingChanges {
 public:
  explicit PendingChanges(std::span<const ParameterChange> changes) : pending_(changes) {}

  // The changes up to `tick` that no earlier call returned. The result is valid as long as the
  // changes of the trace.
  std::span<const ParameterChange> take_until(std::size_t tick) {
    std::size_t count = 0;
    while (count < pending_.size() && pending_[count].tick <= tick) ++count;
    const auto due = pending_.first(count);
    pending_ = pending_.subspan(count);
    return due;
  }

  // The tick of the next change; the largest number if there is none.
  std::size_t next_tick() const {
    return pending_.empty() ? std::numeric_limits<std::size_t>::max() : pending_.front().tick;
  }

 private:
  std::span<const ParameterChange> pending_;
};

// The true state of the vehicle at a tick; the unit receives an estimate of it. For metrics and for
// people (plant_columns.hpp names its columns). Not compared with a golden. World NED, body FRD.
struct PlantSample {
  std::array<float, 3> position_m;    // NED, of the centre of mass
  std::array<float, 3> velocity_m_s;  // NED, of the centre of mass
  std::array<float, 4> q;             // FRD to NED, scalar first
  std::array<float, 3> rate_rad_s;    // FRD
  std::array<float, 8> motor;         // commands of mixer or allocator, -1 stopped .. 1 full
  std::array<float, 8> rotor_rad_s;   // speeds
  float voltage_V;                    // of the battery; 0 without a battery
  std::uint8_t saturated;             // 1: mixer or allocator was in saturation at this tick
};

// The channels that a trace file must have in addition to timestamp.
enum class TraceNeed {
  inputs,             // every in/ channel: to feed a port
  outputs,            // at least one out/ channel: to compare
  inputs_and_outputs  // to replay
};

struct Trace {
  std::string source;                          // file or case, for messages
  std::vector<Sample> samples;                 // one per tick, timestamps strictly increasing
  std::vector<ParameterChange> parameters;     // by tick, then in the order of their setting
  ChannelSet present;                          // the channels that have values; the others are 0
  std::vector<PlantSample> plant;              // of a simulated flight: one per sample; else empty
  std::vector<std::string> ignored_columns{};  // columns of its file that attest does not know
  std::string profile{};                       // that its file says; empty: none

  // Removes all ticks after the first `ticks`, and the parameter changes at them.
  void keep_first(std::size_t ticks) {
    samples.resize(std::min(ticks, samples.size()));
    plant.resize(std::min(ticks, plant.size()));
    std::erase_if(parameters, [&](const ParameterChange& change) { return change.tick >= ticks; });
  }
};

}  // namespace attest
