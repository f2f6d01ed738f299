// The declarations of a port. They determine its cases and their tolerances, so a port that changes
// them later breaks the rules of the ABI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/loop/unit_driver.hpp"
#include "harness/port/port.hpp"

namespace attest {

struct Declarations {
  std::string name, version;
  std::vector<std::string> unsupported_groups;
  Lacks lacks;
  std::optional<int> fraction_bits;  // of a port in fixed point
  std::optional<Rate> fixed_step;    // of a port with a fixed sample time
  ModuleSet modules;
  std::vector<std::string> profiles;     // that it supports; empty unless requested
  bool is_recorded = false;              // its outputs are files; it cannot be called
  std::vector<std::string> files = {};   // of a program: Port::files()
  std::optional<CostCounter> cost = {};  // how it counts the cost of its steps

  // Asks a loaded port. The result has no profiles.
  static Declarations asked(const Port& port);
};

// "its attest.arithmetic is `fixed:20`, it was `none` when the port was asked first; ...": the
// first difference; empty when there is none. The profiles are not compared.
std::string change(const Declarations& said, const Declarations& now);

// The fault of a port whose create(profile) returned NULL. Kind::profile: it does not support the
// profile. Kind::protocol: the profile is in `said.profiles`, so an earlier create() did not return
// NULL.
PortFault no_unit_of(const std::string& profile, const Declarations& said);

// Returns `fault`, but no_unit_of() in place of one of Kind::profile. The judge's process calls it
// too: an answer from the port's process may say that the profile is not supported at any time.
std::optional<PortFault> held_to(const Declarations& said, const std::string& profile,
                                 std::optional<PortFault> fault);

}  // namespace attest
