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

// The port itself failed, or does not support the request. Wrong outputs are not a PortFault: the
// comparison finds them.
struct PortFault {
  // The port's process may send the kinds up to `protocol`, and `crash` if the port is a program
  // (trace_message.hpp). The judge's process finds the others itself.
  enum class Kind {
    profile,      // the profile is not supported, nor was it when the port was described
    module,       // it has no such module, or none of the profile
    unsupported,  // ATTEST_UNSUPPORTED; a mixer or an instance that it does not make
    failed,       // ATTEST_FAILED; ATTEST_INVALID from another function than set_parameter
    refused,      // ATTEST_INVALID from set_parameter: a name or a value that the port refuses
    protocol,     // broke the rules of the ABI
    crash,        // its process, or the program, ended
    timeout,      // no answer in time
    unanswered,   // a recorded port has no outputs for the request
  };
  Kind kind = Kind::failed;
  std::size_t tick = 0;  // in the judged trace; all earlier ticks have outputs
  std::string what;      // one line
};

// Kind::crash or Kind::protocol, at tick 0.
PortFault fault_of(const PortBroke& broke);

class UnitDriver {
 public:
  // REQUIRES: `unit` is of `module`, in its power-on state, and outlives this.
  explicit UnitDriver(Unit& unit, Module module = Module::mc_att_control);

  // Makes one step:
  //
  //     parameters that change at this tick -> set_parameter
  //     the time of the unit's estimate     -> set_timestamp_sample
  //     inputs of `sample`                  -> step
  //     outputs of the step                 -> `sample`
  //
  // The outputs struct holds the outputs of the last step when step is called. Without
  // `timestamp_sample_us`, the time of the estimate is the sample's timestamp. After a fault, the
  // outputs of `sample` are unchanged.
  std::optional<PortFault> step(std::size_t tick, std::span<const ParameterChange> changes,
                                Sample& sample,
                                std::optional<std::uint64_t> timestamp_sample_us = std::nullopt);

  // The same for several ticks from `tick` on. `changes` are set before the first one. Samples
  // before PortFault::tick have outputs. REQUIRES: 1 <= samples.size() <= Unit::max_batch().
  std::optional<PortFault> batch(std::size_t tick, std::span<const ParameterChange> changes,
                                 std::span<Sample> samples);

  std::span<const StepCost> costs() const { return unit_.costs(); }  // of the last step or batch

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
  // The unit's inputs and outputs, each followed by `margin` bytes that a step must not change. A
  // port compiled with larger structs would write there.
  struct Exchange {
    alignas(8) std::array<unsigned char, sizeof(Sample) + margin> in{};
    alignas(8) std::array<unsigned char, sizeof(Sample) + margin> out{};
  } exchange_;
};

}  // namespace attest
