// The declarations of a port. They determine its cases and their tolerances, so a port that changes
// them later breaks the rules of the ABI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/loop/unit_driver.hpp"
#include "harness/port/port.hpp"

namespace attest {

struct PortSays {
  std::string name, version;
  std::vector<std::string> unsupported_groups;
  std::optional<int> fraction_bits;  // of a port in fixed point
  std::optional<Rate> fixed_step;    // of a port with a fixed sample time
  ModuleSet modules;
  std::vector<std::string> profiles;  // of which it made a unit; empty unless requested
  bool is_recorded = false;           // its outputs are files; it cannot be called
  ChannelSet not_recorded = {};       // outputs that these files do not have: not judged

  // Of a port that is loaded; the profiles stay empty.
  static PortSays asked(const Port& port);
};

// "its attest.arithmetic is `fixed:20`, it was `none` when the port was asked first; ..."; empty
// when both say the same. The profiles are not compared.
std::string change(const PortSays& said, const PortSays& now);

// The fault of a port whose create(profile) returned NULL: it does not support the profile, or it
// breaks the rules of the ABI, because it made a unit of that profile when it was asked first.
PortFault no_unit_of(const std::string& profile, const PortSays& said);

}  // namespace attest
