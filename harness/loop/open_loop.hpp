// Steps a unit with the inputs of a trace, and records the unit's outputs in the trace.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Replaces the outputs of `trace` by those of `unit`. After a fault, the samples before
// PortFault::tick have the unit's outputs. REQUIRES: a unit of `module` in its power-on state.
std::optional<PortFault> drive(Unit& unit, Trace& trace, Module module = Module::mc_att_control);

// A part of a trace that is too long for one request. One instance steps all parts.
struct Part {
  std::size_t first_tick = 0;  // of the part, in the trace; 0: a fresh instance
  bool is_last = true;         // then the instance is destroyed
};

// The module of a port that is stepped, and how it is created.
struct ModuleUnderTest {
  std::string profile;
  Module module = Module::mc_att_control;
  std::string mixer = {};  // only for Module::mixer: "R: 4x 10000 10000 10000 0"
  Instances instances = Instances::one;
  Part part = {};  // REQUIRES: Instances::one, if the trace has several parts
  std::vector<std::string> other_profiles = {};  // whose turn it is in Instances::other_profiles
};

ModuleUnderTest subject_of(const Case& the_case);

// Makes a unit of the subject's module, in its power-on state. The port must outlive the unit.
// Faults, at tick 0: Kind::profile, Kind::module, Kind::unsupported.
tl::expected<std::unique_ptr<Unit>, PortFault> make_unit(Port& port,
                                                         const ModuleUnderTest& subject);

// The fault of a port that made no unit of the subject's module. Kind::profile; Kind::module, if
// the port makes another module of that profile, such as a law alone; Kind::unsupported of a mixer.
PortFault why_no_unit(Port& port, const ModuleUnderTest& subject);

// Steps a fresh instance of the subject's module through the trace. `subject.instances` says which
// other instances of the port exist before it or at the same time. On two threads, the steps of a
// port that is one at a time alternate. Kind::unsupported: the port cannot make the second instance
// while the first one exists. REQUIRES: the subject's part is the whole trace.
std::optional<PortFault> drive(Port& port, const ModuleUnderTest& subject, Trace& trace);

// Steps one instance through the parts of a trace.
class PartDriver {
 public:
  // REQUIRES: a unit of `module` in its power-on state.
  PartDriver(std::unique_ptr<Unit> unit, Module module)
      : unit_(std::move(unit)), driver_(*unit_, module) {}

  // Same as drive(), for the next part. PortFault::tick is in the trace as a whole. REQUIRES: no
  // fault before.
  std::optional<PortFault> drive(Trace& part, std::size_t first_tick);

 private:
  std::unique_ptr<Unit> unit_;
  UnitDriver driver_;
};

}  // namespace attest
