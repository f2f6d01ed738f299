// The catalogue of faults as data: mistakes that ports of the controller and of the cascade make.
// Each fault changes stages, inputs or outputs of the reference (faulty_controller.hpp). The share
// of faults that a suite catches is a measure of the suite. The diagnosis compares a failing port
// with the faults.
//
// The table is static and constant; any thread.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "controller/cascade/profile.hpp"
#include "controller/mc_att_control/profile.hpp"

namespace attest::faults {

using mc_att_control::Profile;
struct FaultyLaw;

// The part of the law that contains the mistake.
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
  sticks,
  yaw_lock,
  throttle,
  latching,
  estimator_reset,
  autotune,
  saturation,
  yaw_filter,
  reference_model,
  functions,  // elementary/elementary.hpp; of no fault of the catalogue
};
std::string_view name_of(Stage stage);  // "integrator gate"

// Profiles of one law: of the controller, or of the cascade.
class ProfileSet {
 public:
  constexpr ProfileSet(mc_att_control::ProfileRange profiles) : controller_(profiles) {}
  constexpr ProfileSet(cascade::ProfileRange profiles) : cascade_(profiles) {}

  // Returns false if no profile has that name.
  bool contains(std::string_view profile) const;
  // Whether `profile` belongs to the law of this set. It need not be in the set.
  bool is_of_law_of(std::string_view profile) const;

 private:
  std::optional<mc_att_control::ProfileRange> controller_;
  std::optional<cascade::ProfileRange> cascade_;
};

struct Fault {
  std::string_view id;     // "quat-order-xyzw"
  std::string_view group;  // of the cases that must catch it: "attitude"
  Stage stage;             // the part of the law that contains the mistake
  std::string_view what;   // its effect in one line: "takes quaternions as x, y, z, w"
  std::string_view shows;  // the situation that makes it visible: "any attitude except level"
  std::string_view kind;   // of porting mistake: "quaternion order"
  void (*inject)(FaultyLaw& law);
  // If not empty: the reason why no input can distinguish the fault from the law.
  std::string_view equivalent = {};
  // The profiles in which some input distinguishes the fault from the law. If empty, the catalogue
  // fills in the profiles that have the part of the law concerned.
  std::optional<ProfileSet> profiles = {};

  bool is_detectable(std::string_view profile) const {
    return equivalent.empty() && profiles->contains(profile);
  }
};

// All faults, sorted by subject. The pointers stay valid until the program ends.
std::span<const Fault* const> catalogue();

// Returns null if no fault has that id.
const Fault* find_fault(std::string_view id);

}  // namespace attest::faults
