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

// ModuleUnit is Unit, MixerUnit or BatteryUnit.
template <typename ModuleUnit>
class ModuleDriver {
 public:
  // REQUIRES: the unit is in its power-on state, and outlives this.
  explicit ModuleDriver(ModuleUnit& unit);

  // One tick:
  //
  //     parameters that change at this tick -> set_parameter
  //     the time of the control_state       -> set_timestamp_sample, of a Unit
  //     inputs of the sample                -> step
  //     outputs                             -> the sample; kept as the next step's starting point
  //
  // `timestamp_sample_us` is when control_state was taken; empty: at the sample's timestamp.
  // On a fault the sample's outputs are not written.
  std::optional<PortFault> step(std::size_t tick, std::span<const ParameterChange> changes,
                                Sample& sample,
                                std::optional<std::uint64_t> timestamp_sample_us = std::nullopt);

  // The same for several ticks from `tick` on, of which only the first changes parameters. Samples
  // before the fault have outputs. REQUIRES: 1 <= samples.size() <= ModuleUnit::max_batch().
  std::optional<PortFault> batch(std::size_t tick, std::span<const ParameterChange> changes,
                                 std::span<Sample> samples);

 private:
  using Inputs = typename ModuleUnit::Inputs;
  using Outputs = typename ModuleUnit::Outputs;

  // The unit's inputs and outputs, each followed by bytes that must not change. A port compiled
  // with another layout writes there first.
  struct Exchange {
    Inputs in{};
    std::array<unsigned char, 64> canary_in;
    Outputs out{};
    std::array<unsigned char, 64> canary_out;
  };

  std::optional<PortFault> set_parameters(std::size_t tick,
                                          std::span<const ParameterChange> changes);
  std::optional<PortFault> step_once(std::size_t tick, Sample& sample,
                                     std::optional<std::uint64_t> timestamp_sample_us);
  std::optional<PortFault> step_all(std::size_t tick, std::span<Sample> samples);
  int tell_time(const Inputs& given, std::optional<std::uint64_t> timestamp_sample_us);
  std::optional<PortFault> broken_rule(const Inputs& given, std::size_t tick) const;

  ModuleUnit& unit_;
  Exchange exchange_;
};

extern template class ModuleDriver<Unit>;
extern template class ModuleDriver<MixerUnit>;
extern template class ModuleDriver<BatteryUnit>;

using UnitDriver = ModuleDriver<Unit>;

}  // namespace attest
