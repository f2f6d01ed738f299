// One trace in, one trace out: a unit is given the inputs of a trace and its outputs are recorded.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Replaces the outputs of `trace` by those of a fresh `unit` of `module`. On a fault the samples
// before it are valid.
std::optional<PortFault> drive(Unit& unit, Trace& trace, Module module = Module::mc_att_control);

// The part of a port that receives a trace.
struct Subject {
  std::string profile;
  Module module = Module::mc_att_control;
  std::string mixer = {};  // definition of a Module::mixer: "R: 4x 10000 10000 10000 0"
  Instances instances = Instances::one;
};

Subject subject_of(const Case& the_case);

// A fresh unit of the subject's module, or why the port makes none. The port must outlive it.
tl::expected<std::unique_ptr<Unit>, PortFault> make_unit(Port& port, const Subject& subject);

// Steps a fresh instance of the subject's module through the trace. `Instances` says which other
// instance of the port exists before it or at the same time. A port that cannot make a second
// instance while one exists does not support such a subject.
std::optional<PortFault> drive(Port& port, const Subject& subject, Trace& trace);

}  // namespace attest
