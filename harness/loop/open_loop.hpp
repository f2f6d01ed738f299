// One trace in, one trace out: a unit is given the inputs of a trace and its outputs are recorded.
#pragma once

#include <optional>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Replaces the outputs of `trace` by those of a fresh `unit`. On a fault the samples before it are
// valid.
std::optional<PortFault> drive(Unit& unit, Trace& trace);

// What of a port a trace is given to.
struct Subject {
  std::string profile;
  Module module = Module::mc_att_control;
  std::string mixer = {};  // of Module::mixer, its definition: "R: 4x 10000 10000 10000 0"
  Instances instances = Instances::one;
};

Subject subject_of(const Case& the_case);

// The same with a fresh instance of that module of the port, in the company that the subject says.
// A port that makes no second instance beside a living one does not support such a subject.
std::optional<PortFault> drive(Port& port, const Subject& subject, Trace& trace);

}  // namespace attest
