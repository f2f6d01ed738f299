// The stages of the multirotor mixer, in the order they run. Pure; any thread.
//
// The algorithm of PX4 v1.5.5 MultirotorMixer. When motors saturate, it first changes collective
// thrust to keep roll and pitch. Where that is not enough, it scales roll and pitch down. At the
// end it cuts yaw, rotor by rotor.
#pragma once

#include <cfloat>
#include <cmath>
#include <span>

#include "controller/actuation/mixer_geometry.hpp"

namespace attest::actuation {

// Roll, pitch, yaw about body x, y, z (FRD), dimensionless, and thrust 0..1.
template <typename Scalar>
struct MixerControls {
  Scalar roll;
  Scalar pitch;
  Scalar yaw;
  Scalar thrust;
};

template <typename Scalar>
struct MixerScales {
  Scalar roll, pitch, yaw;
  Scalar idle;  // command of a motor at an output of 0
};

// Fits saturated roll and pitch between the motors' limits.
template <typename Scalar>
struct MixerFit {
  Scalar boost = 0;             // added to the thrust of all rotors
  Scalar roll_pitch_scale = 1;  // factor on roll and pitch
};

// The saturation in one call. The controller gets it as multirotor_motor_limits.
struct Saturation {
  bool lower;  // roll, pitch and thrust demanded less than idle from a motor
  bool upper;  // roll, pitch and thrust demanded more than full from a motor
  bool yaw;    // yaw was cut
};

template <typename Scalar>
struct MixerStages {
  using Controls = MixerControls<Scalar>;
  using Scales = MixerScales<Scalar>;
  using Fit = MixerFit<Scalar>;

  // To keep roll and pitch, thrust may be raised to 1.5 times, or lowered to 0.6 times, its
  // command.
  static constexpr Scalar thrust_raise = Scalar(1.5f);
  static constexpr Scalar thrust_lower = Scalar(0.6f);

  // The most by which one saturated rotor may lower the thrust, to keep yaw authority.
  static constexpr Scalar thrust_for_yaw_max = Scalar(0.15f);

  // NaN passes unchanged: both comparisons are false.
  static Scalar clamp(Scalar value, Scalar low, Scalar high) {
    return value < low ? low : (value > high ? high : value);
  }

  static Controls scaled(const Controls& c, const Scales& scales) {
    return {clamp(c.roll * scales.roll, -1, 1), clamp(c.pitch * scales.pitch, -1, 1),
            clamp(c.yaw * scales.yaw, -1, 1), clamp(c.thrust, 0, 1)};
  }

  static Scalar without_yaw(const Rotor& rotor, const Controls& c, Scalar roll_pitch_scale) {
    return (c.roll * Scalar(rotor.roll) + c.pitch * Scalar(rotor.pitch)) * roll_pitch_scale;
  }

  // min_out and max_out are the smallest and largest output of all rotors, without yaw.
  static Saturation saturation(Scalar min_out, Scalar max_out) {
    return {min_out<0, max_out> 1, false};
  }

  static Fit fit(Scalar min_out, Scalar max_out, Scalar thrust) {
    const Scalar up = thrust * thrust_raise - thrust;
    const Scalar down = thrust - thrust * thrust_lower;
    const auto boosted_from_below = [=](Scalar boost) {
      return Fit{boost, (thrust + boost) / (thrust - min_out)};
    };
    const auto boosted_from_above = [=](Scalar boost) {
      return Fit{boost, (1 - (thrust + boost)) / (max_out - thrust)};
    };
    const bool below = min_out < 0;
    const bool above = max_out > 1;
    if (below && max_out < 1) {
      if (-min_out <= 1 - max_out) {
        return up >= -min_out ? Fit{-min_out, 1} : boosted_from_below(up);
      }
      return boosted_from_below(clamp(-min_out - (1 - max_out) / 2, 0, up));
    }
    if (above && min_out > 0) {
      if (min_out >= max_out - 1) {
        return down >= max_out - 1 ? Fit{-(max_out - 1), 1} : boosted_from_above(-down);
      }
      return boosted_from_above(clamp(-(max_out - 1 - min_out) / 2, -down, 0));
    }
    if (below && above) {
      return boosted_from_below(clamp(-(max_out - 1 + min_out) / 2, thrust_lower * thrust - thrust,
                                      thrust_raise * thrust - thrust));
    }
    return {};
  }

  // Goes through the rotors in order. At a rotor outside its limits it cuts yaw, and at the upper
  // limit first some thrust. Later rotors are tested with the new values, and the last values hold
  // for all rotors. Returns whether yaw was cut.
  static bool yield_yaw(std::span<const Rotor> rotors, Controls& c, const Fit& fit) {
    bool cut = false;
    for (const Rotor& rotor : rotors) {
      const Scalar roll_pitch = without_yaw(rotor, c, fit.roll_pitch_scale);
      const Scalar turn = Scalar(rotor.yaw);
      const Scalar out = roll_pitch + c.yaw * turn + c.thrust + fit.boost;
      const bool has_yaw = std::abs(rotor.yaw) > FLT_EPSILON;
      if (out < 0) {
        c.yaw = has_yaw ? -(roll_pitch + c.thrust + fit.boost) / turn : Scalar(0);
        cut = true;
      } else if (out > 1) {
        using std::fmin;
        c.thrust -= fmin(thrust_for_yaw_max, out - 1);
        c.yaw = has_yaw ? (1 - (roll_pitch + c.thrust + fit.boost)) / turn : Scalar(0);
        cut = true;
      }
    }
    return cut;
  }

  static Scalar command(const Rotor& rotor, const Controls& c, const Fit& fit, Scalar idle) {
    const Scalar out = without_yaw(rotor, c, fit.roll_pitch_scale) + c.yaw * Scalar(rotor.yaw) +
                       c.thrust + fit.boost;
    return clamp(idle + out * (1 - idle), idle, 1);
  }

  // At the first call there is no previous output. With a deadband, slew() then starts from 0.
  // Without a deadband (idle is -1), the first output is not limited.
  static bool starts_at_0(Scalar idle) { return idle > Scalar(-1); }

  static Scalar slew(Scalar wanted, Scalar previous, Scalar delta_out_max) {
    if (!(delta_out_max > 0)) return wanted;
    const Scalar delta = wanted - previous;
    if (delta > delta_out_max) return previous + delta_out_max;
    if (delta < -delta_out_max) return previous - delta_out_max;
    return wanted;
  }
};

}  // namespace attest::actuation
