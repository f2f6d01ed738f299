// The catalogue of wrong controllers as data: the mistakes that ports of this law make, each the
// reference with one stage replaced (faulty_controller.hpp). A suite is measured by how many of
// them it catches, and a port that fails is compared with them to say what it looks like.
//
// The table is static and constant; any thread.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "controller/reference/profile.hpp"

namespace attest::faults {

using reference::Profile;
struct FaultyLaw;

// Where in the law the mistake is.
enum class Stage {
  input,
  tilt,
  yaw,
  blend,
  limit,
  feed_forward,
  weathervane,
  tpa,
  p,
  i,
  d,
  ff,
  gate,
  guard,
  scaling,
  mode,
  arming,
  parameters,
  timing,
  recovery,
  output,
  mixer_scaling,
  mixer_fit,
  mixer_yaw,
  mixer_output,
  battery_status,
};
std::string_view name_of(Stage stage);  // "integrator gate"

struct Fault {
  std::string_view id;     // "quat-order-xyzw"
  std::string_view group;  // of the cases that must catch it: "attitude"
  Stage stage;             //
  std::string_view what;   // one line: what it does
  std::string_view shows;  // in which situation
  std::string_view kind;   // of porting mistake: "quaternion order"
  void (*inject)(FaultyLaw& law);
  // Not empty: no input can tell it from the law, and why.
  std::string_view equivalent = {};
  // The profiles in which some input can: those that have what is wrong here. Empty: those of the
  // fault's subject, which the catalogue fills in.
  std::optional<reference::ProfileSet> profiles = {};

  bool is_detectable(Profile profile) const {
    return equivalent.empty() && profiles->contains(profile);
  }
};

// In the order of the groups. The pointers stay valid until the program ends.
std::span<const Fault* const> catalogue();

// Null when there is none of that id.
const Fault* find_fault(std::string_view id);

}  // namespace attest::faults
