// The multirotor mixer: from torque and thrust controls to motor commands, with saturation.
//
// The algorithm of PX4 v1.5.5 MultirotorMixer: when motors saturate, roll and pitch are kept as
// long as collective thrust can be traded for them, then scaled; yaw gives way last, rotor by
// rotor.
//
// Controls: roll, pitch, yaw about body x, y, z (FRD), dimensionless, and thrust 0..1. Motor
// commands are -1 (stopped) .. 1 (full). All in binary32. mix() does not allocate; a mixer holds
// the previous commands and belongs to one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace attest::actuation {

// What one unit of each control does to one motor.
struct Rotor {
  float roll;
  float pitch;
  float yaw;  // +1 turns counter-clockwise seen from above, -1 clockwise
};

struct Controls {
  float roll;
  float pitch;
  float yaw;
  float thrust;
};

// What the mixer had to give up in one call: goes back to the controller as
// multirotor_motor_limits.
struct Saturation {
  bool lower;  // a motor was asked for less than idle
  bool upper;  // a motor was asked for more than full
  bool yaw;    // yaw was cut
};

class Mixer {
 public:
  static constexpr std::size_t rotors_max = 8;

  // From one line of a mixer file, "R: <geometry> <roll> <pitch> <yaw> <deadband>", such as
  // "R: 4x 10000 10000 10000 0". Geometries: 4x 4+ 6x 8x. The numbers are integers in 1/10000:
  // scales of the controls, and the fraction of the range in which a motor does not turn. The
  // error says what is wrong with the text.
  static tl::expected<Mixer, std::string> parse(std::string_view text);

  // One command for each rotor, valid until the next call. delta_out_max [1] limits the change of
  // each command since the previous call, which starts from 0; not positive: no limit.
  std::span<const float> mix(const Controls& controls, float delta_out_max, Saturation& saturation);

  std::size_t rotor_count() const { return rotors_.size(); }

  std::span<const Rotor> rotors() const { return rotors_; }

 private:
  struct Scales {
    float roll, pitch, yaw, idle;
  };

  // How saturated roll and pitch are fitted between the motors' limits.
  struct Fit {
    float boost = 0.0f;             // added to the thrust of all rotors
    float roll_pitch_scale = 1.0f;  // what is left of roll and pitch
  };

  Mixer(std::span<const Rotor> rotors, const Scales& scales) : rotors_(rotors), scales_(scales) {}

  Controls scaled(const Controls& controls) const;
  static Fit fit(float min_out, float max_out, float thrust);
  bool yield_yaw(Controls& controls, const Fit& fit) const;
  float command(const Rotor& rotor, const Controls& controls, const Fit& fit) const;
  static float slew(float wanted, float previous, float delta_out_max);

  std::span<const Rotor> rotors_;  // of the static geometry table
  Scales scales_;
  std::array<float, rotors_max> commands_{};
};

}  // namespace attest::actuation
