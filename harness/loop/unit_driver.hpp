// Gives a unit one sample after another by the rules of the ABI, and detects when the unit breaks
// them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The port itself failed, or declared that it does not support this. Wrong values are found by the
// comparison.
struct PortFault {
  enum class Kind {
    profile,      // the profile is not supported
    unsupported,  // ATTEST_UNSUPPORTED, or a module that the port does not have
    failed,       // ATTEST_FAILED, ATTEST_INVALID
    protocol,     // broke the rules of the ABI
    crash,        // its process died
    timeout,      // no answer in time
    unanswered,   // by a recorded port, which cannot be called
  };
  Kind kind = Kind::failed;
  std::size_t tick = 0;  // of the judged trace: the ticks before it have outputs
  std::string what;      // one line
};

// A crash or a broken protocol, at tick 0.
PortFault fault_of(const PortBroke& broke);

class UnitDriver {
 public:
  // REQUIRES: the unit is one of `module`, in its power-on state, and outlives this.
  explicit UnitDriver(Unit& unit, Module module = Module::mc_att_control);

  // One tick:
  //
  //     parameters that change at this tick -> set_parameter
  //     the time of the control_state       -> set_timestamp_sample
  //     inputs of the sample                -> step
  //     outputs                             -> the sample; kept as the next step's starting point
  //
  // `timestamp_sample_us` is when control_state was taken; empty: at the sample's timestamp.
  // On a fault the sample's outputs are not written.
  std::optional<PortFault> step(std::size_t tick, std::span<const ParameterChange> changes,
                                Sample& sample,
                                std::optional<std::uint64_t> timestamp_sample_us = std::nullopt);

  // The same for several ticks from `tick` on, of which only the first changes parameters. Samples
  // before the fault have outputs. REQUIRES: 1 <= samples.size() <= Unit::max_batch().
  std::optional<PortFault> batch(std::size_t tick, std::span<const ParameterChange> changes,
                                 std::span<Sample> samples);

 private:
  static constexpr std::size_t margin = 64;

  std::optional<PortFault> set_parameters(std::size_t tick,
                                          std::span<const ParameterChange> changes);
  std::optional<PortFault> step_once(std::size_t tick, Sample& sample,
                                     std::optional<std::uint64_t> timestamp_sample_us);
  std::optional<PortFault> step_all(std::size_t tick, std::span<Sample> samples);
  std::optional<PortFault> broken_rule(const Sample& given, std::size_t tick) const;

  Unit& unit_;
  const ModuleInfo& info_;
  // The unit's inputs and outputs, each followed by bytes that must not change. A port compiled
  // with another layout writes there first.
  struct Exchange {
    alignas(8) std::array<unsigned char, sizeof(Sample) + margin> in{};
    alignas(8) std::array<unsigned char, sizeof(Sample) + margin> out{};
  } exchange_;
};

}  // namespace attest
