// Steps a unit with the inputs of a trace, and records the unit's outputs in the trace.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Replaces the outputs of `trace` by those of `unit`. After a fault, the samples before
// PortFault::tick have the unit's outputs. REQUIRES: a unit of `module` in its power-on state.
std::optional<PortFault> drive(Unit& unit, Trace& trace, Module module = Module::mc_att_control);

// The module of a port that is stepped, and how it is created.
struct Subject {
  std::string profile;
  Module module = Module::mc_att_control;
  std::string mixer = {};  // only for Module::mixer: "R: 4x 10000 10000 10000 0"
  Instances instances = Instances::one;
};

Subject subject_of(const Case& the_case);

// Makes a unit of the subject's module, in its power-on state. The port must outlive the unit.
// Faults, at tick 0: Kind::profile, Kind::unsupported.
tl::expected<std::unique_ptr<Unit>, PortFault> make_unit(Port& port, const Subject& subject);

// Steps a fresh instance of the subject's module through the trace. `subject.instances` says which
// other instance of the port exists before it or at the same time. Kind::unsupported: the port
// cannot make the second instance while the first one exists.
std::optional<PortFault> drive(Port& port, const Subject& subject, Trace& trace);

}  // namespace attest
