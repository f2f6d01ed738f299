// The catalogue of wrong controllers: the mistakes that ports of this law make, each the reference
// with one stage replaced. A suite is measured by how many of them it catches, and a port that
// fails is compared with them to say what it looks like.
//
// The table is static and constant; any thread.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "controller/attest_unit.h"
#include "controller/faults/faulty_law.hpp"

namespace attest::faults {

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
  void (*put_in)(FaultyLaw& law);
  // Not empty: no input can tell it from the law, and why.
  std::string_view equivalent = {};
  // The profiles in which some input can: those that have what is wrong here. Empty: those of the
  // fault's subject, which the catalogue fills in.
  std::optional<reference::ProfileSet> profiles = {};

  bool is_killable(Profile profile) const {
    return equivalent.empty() && profiles->contains(profile);
  }
};

// In the order of the groups. The pointers stay valid until the program ends.
std::span<const Fault* const> catalogue();

// Null when there is none of that id.
const Fault* find_fault(std::string_view id);

// The law with these mistakes in it, together.
FaultyLaw law_with(std::span<const Fault* const> faults);

// A controller of profile `px4-v1.5.5` or `px4-v1.3.4` with some mistakes.
class FaultyController {
 public:
  FaultyController(Profile profile, std::span<const Fault* const> faults);
  ~FaultyController();

  // As of McAttControl.
  bool set_parameter(std::string_view name, float value);
  void step(const attest_inputs& in, attest_outputs& out);

 private:
  FaultyLaw law_;
  struct Controller;
  std::unique_ptr<Controller> controller_;
};

}  // namespace attest::faults
