// Mistakes in stabilized mode of the cascade that every profile has: tilt, yaw rate, throttle.
#include <algorithm>
#include <cmath>

#include "controller/elementary/elementary.hpp"
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using cascade::product;

template <typename Change>
void change_sticks(FaultyLaw& law, Change change) {
  also_before(law.attitude_unit, [change](AttitudeIn& in) { change(in.manual_control_setpoint); });
}
using SticksIn = decltype(AttitudeIn::manual_control_setpoint);

// Replaces the combination of yaw and tilt. Combine is Quat(yaw, tilt).
template <typename Combine>
void change_desired(FaultyLaw& law, Combine combine) {
  law.attitude_unit.sticks.desired_attitude = combine;
}

template <typename Limit>
void change_tilt_limit(FaultyLaw& law, Limit limit) {
  law.attitude_unit.sticks.limited_tilt = [limit](Scalar x, Scalar y, const StickGains& gains) {
    return Vector(limit(x, y, gains.tilt_max_rad));
  };
}

// Rotates by the roll angle first, then by the pitch angle.
Quat tilt_of_angles(const Vector& v) {
  const Quat roll(elementary::cos(v[0] / 2), elementary::sin(v[0] / 2), 0, 0);
  const Quat pitch(elementary::cos(v[1] / 2), 0, elementary::sin(v[1] / 2), 0);
  return product(pitch, roll);
}

void filter_roll_only(FaultyLaw& law) {
  auto pitch = std::make_shared<Scalar>(0.0f);
  also_before(law.attitude_unit, [pitch, stick = 0.0f](AttitudeIn& in) mutable {
    if ((in.updated & ATTEST_ATTITUDE_UPDATED_MANUAL_CONTROL_SETPOINT) != 0) {
      stick = in.manual_control_setpoint.pitch;
    }
    *pitch = stick;
  });
  change_stage(law.attitude_unit.sticks.limited_tilt,
               [pitch](const auto& then, Scalar x, Scalar, const StickGains& gains) {
                 return then(x, -*pitch * gains.tilt_max_rad, gains);
               });
}

template <typename Test>
void change_lowest_throttle(FaultyLaw& law, Test test) {
  law.attitude_unit.sticks.is_lowest_throttle = test;
}

// The setpoint turns with the yaw stick, but commands no yaw rate.
void command_no_yaw_rate(FaultyLaw& law) {
  struct Seen {
    cascade::LowPass<Scalar> filter;
    Scalar dt_s = 0, rate = 0;
  };
  auto seen = std::make_shared<Seen>();
  auto& step_time = law.attitude_unit.step.step_time;
  change_stage(step_time, [seen](const auto& then, std::uint64_t now_us, std::uint64_t last_us) {
    return seen->dt_s = then(now_us, last_us);
  });
  auto& sticks = law.attitude_unit.sticks;
  change_stage(sticks.straight_yaw_rate,
               [seen](const auto& then, Scalar stick, const StickGains& gains) {
                 seen->rate = then(stick, gains);
                 return 0.0f;
               });
  change_stage(sticks.integrated_yaw, [seen](const auto& then, Scalar yaw, Scalar, Scalar dt_s) {
    return then(yaw, seen->rate, dt_s);
  });
  change_stage(
      sticks.shaped_yaw_rate, [seen](const auto& then, Scalar stick, const StickGains& gains) {
        const CascadeTraits traits{};
        seen->rate = seen->filter.update(gains.yaw_tau_s, seen->dt_s, then(stick, gains), traits);
        return 0.0f;
      });
  change_stage(sticks.locked_yaw, [seen](const auto& then, Scalar yaw, Scalar, Scalar heading,
                                         Scalar old, Scalar correction) {
    return then(yaw, seen->rate, heading, old, correction);
  });
}

// The yaw stick counts as centred while the vehicle has landed.
void centre_yaw_stick_while_landed(FaultyLaw& law) {
  auto landed = std::make_shared<bool>(true);
  auto& runs = law.attitude_unit.step.runs;
  change_stage(runs, [landed](const auto& then, const cascade::AttitudeTopics& topics) {
    *landed = topics.landed;
    return then(topics);
  });
  auto& sticks = law.attitude_unit.sticks;
  for (auto* rate : {&sticks.straight_yaw_rate, &sticks.shaped_yaw_rate}) {
    *rate = [landed, then = *rate](Scalar stick, const StickGains& gains) {
      return *landed ? 0.0f : then(stick, gains);
    };
  }
}

// cascade::heading() with the arguments of atan2 exchanged.
Scalar heading_from_east(const Quat& q, const CascadeTraits& law) {
  if (cascade::pole_at(2 * (q[1] * q[3] - q[0] * q[2])) != 0) return cascade::heading(q, law);
  const Scalar R00 = law.squares_heading ? q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3]
                                         : 1 - 2 * (q[2] * q[2] + q[3] * q[3]);
  return elementary::atan2(R00, 2 * (q[1] * q[2] + q[0] * q[3]));
}

// Turns the tilt of a VTOL in another way. Turned is Quat(tilt, desired yaw, q_WB, lean of the
// body).
template <typename Turned>
void turn_tilt(FaultyLaw& law, Turned turned) {
  law.attitude_unit.sticks.tilt_for_yaw_error = [turned](const Quat& tilt, const Quat& desired,
                                                         const Quat& q_WB) {
    const Vector up(0, 0, 1);
    const Quat lean = cascade::shortest_rotation(up, cascade::z_axis(q_WB));
    return cascade::shortest_rotation(up, cascade::z_axis(turned(tilt, desired, q_WB, lean)));
  };
}

const Fault stick_list[] = {
    {"cascade-sticks-exchanged", "sticks", Stage::sticks, "exchanges roll and pitch stick",
     "one of the sticks", "wrong axis",
     [](FaultyLaw& law) {
       change_sticks(law, [](SticksIn& sticks) { std::swap(sticks.roll, sticks.pitch); });
     }},
    {"cascade-pitch-stick-reversed", "sticks", Stage::sticks, "pitches up with the stick forward",
     "the pitch stick", "a sign",
     [](FaultyLaw& law) {
       change_sticks(law, [](SticksIn& sticks) { sticks.pitch = -sticks.pitch; });
     }},
    {"cascade-roll-stick-reversed", "sticks", Stage::sticks, "rolls left with the stick right",
     "the roll stick", "a sign",
     [](FaultyLaw& law) {
       change_sticks(law, [](SticksIn& sticks) { sticks.roll = -sticks.roll; });
     }},
    {"cascade-yaw-stick-reversed", "sticks", Stage::sticks, "yaws left with the stick right",
     "the yaw stick", "a sign",
     [](FaultyLaw& law) {
       change_sticks(law, [](SticksIn& sticks) { sticks.yaw = -sticks.yaw; });
     }},
    {"cascade-tilt-sticks-clamped", "robustness", Stage::sticks, "clamps roll and pitch stick",
     "a stick beyond 1 with a slow filter", "a helpful extra",
     [](FaultyLaw& law) {
       change_sticks(law, [](SticksIn& sticks) {
         sticks.roll = std::clamp(sticks.roll, -1.0f, 1.0f);
         sticks.pitch = std::clamp(sticks.pitch, -1.0f, 1.0f);
       });
     }},
    {"cascade-tilt-stick-deadzone", "sticks", Stage::sticks,
     "gives roll and pitch stick a deadzone", "a small stick", "a helpful extra",
     [](FaultyLaw& law) {
       change_sticks(law, [](SticksIn& sticks) {
         for (float* stick : {&sticks.roll, &sticks.pitch}) {
           if (std::abs(*stick) < 0.05f) *stick = 0;
         }
       });
     }},
    {"cascade-tilt-not-limited", "sticks", Stage::sticks,
     "does not limit the tilt of both sticks together", "both sticks at full", "a missing clamp",
     [](FaultyLaw& law) {
       change_tilt_limit(law, [](Scalar x, Scalar y, Scalar) { return Vector(x, y, 0); });
     }},
    {"cascade-tilt-limited-by-axis", "sticks", Stage::sticks, "limits the tilt of each axis",
     "both sticks at full", "another limit",
     [](FaultyLaw& law) {
       change_tilt_limit(law, [](Scalar x, Scalar y, Scalar max) {
         return Vector(cascade::clamp(x, -max, max), cascade::clamp(y, -max, max), 0);
       });
     }},
    {"cascade-tilt-of-square", "sticks", Stage::sticks,
     "scales the tilt to the circle at every deflection", "both sticks at half", "another limit",
     [](FaultyLaw& law) {
       change_tilt_limit(law, [](Scalar x, Scalar y, Scalar) {
         const Scalar longest = std::max(std::abs(x), std::abs(y));
         const Vector v(x, y, 0);
         return longest > 0 ? Vector(v * (longest / v.norm())) : v;
       });
     }},
    {"cascade-tilt-max-in-degrees", "sticks", Stage::sticks, "takes MPC_MAN_TILT_MAX as rad",
     "the roll stick", "degrees",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters& p) {
         gains.sticks.tilt_max_rad = p.mpc_man_tilt_max;
       });
     }},
    {"cascade-tilt-is-angles", "sticks", Stage::sticks,
     "takes the sticks as roll and pitch angle instead of a rotation vector", "both sticks at half",
     "another rotation", [](FaultyLaw& law) { law.attitude_unit.sticks.tilt = tilt_of_angles; }},
    {"cascade-tilt-half-angle", "sticks", Stage::sticks,
     "does not halve the tilt angle for the quaternion", "the roll stick", "a missing factor",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.tilt = [](const Vector& v) {
         return cascade::rotation_about<Scalar>(2 * v);
       };
     }},
    {"cascade-tilt-filter-missing", "sticks", Stage::sticks, "does not filter the tilt",
     "MC_MAN_TILT_TAU and a stick that moves", "a missing filter",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters&) {
         gains.sticks.tilt_tau_s = 0;
       });
     }},
    {"cascade-tilt-filter-on-roll-only", "sticks", Stage::sticks, "filters the roll stick only",
     "MC_MAN_TILT_TAU and a pitch stick that moves", "a missing axis", filter_roll_only},
    {"cascade-tilt-filter-kept", "sticks", Stage::sticks,
     "does not clear the filter of the tilt in other modes",
     "MC_MAN_TILT_TAU and a change to position mode and back", "a missing reset",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.clears_tilt = [](bool, const CascadeTraits&) { return false; };
     }},
    {"cascade-yaw-then-tilt", "sticks", Stage::sticks, "tilts about the world's axes",
     "a tilt at a heading other than north", "factors exchanged",
     [](FaultyLaw& law) {
       change_desired(law, [](const Quat& yaw, const Quat& tilt) { return product(tilt, yaw); });
     }},
    {"cascade-yaw-not-halved", "sticks", Stage::sticks,
     "does not halve the yaw angle for the quaternion", "a heading other than north",
     "a missing factor",
     [](FaultyLaw& law) {
       change_desired(
           law, [](const Quat& yaw, const Quat& tilt) { return product(product(yaw, yaw), tilt); });
     }},
    {"cascade-yaw-rate-in-degrees", "sticks", Stage::sticks, "takes MPC_MAN_Y_MAX as rad/s",
     "the yaw stick", "degrees",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters& p) {
         gains.sticks.yaw_rate_max_rad_s = p.mpc_man_y_max;
       });
     }},
    {"cascade-yaw-rate-not-fed-forward", "sticks", Stage::sticks,
     "publishes a yaw_sp_move_rate of 0", "the yaw stick", "a missing term",
     [](FaultyLaw& law) {
       also_after(law.attitude_unit, [](const AttitudeIn&, AttitudeOut& out) {
         out.vehicle_attitude_setpoint.yaw_sp_move_rate = 0;
       });
     }},
    {"cascade-yaw-stick-turns-only", "sticks", Stage::sticks,
     "turns the setpoint with the yaw stick, but commands a yaw rate of 0", "the yaw stick",
     "a missing term", command_no_yaw_rate},
    {"cascade-yaw-stick-off-landed", "modes", Stage::sticks, "ignores the yaw stick while landed",
     "the yaw stick on the ground", "a helpful extra", centre_yaw_stick_while_landed},
    {"cascade-heading-atan2-exchanged", "sticks", Stage::sticks,
     "exchanges the arguments of atan2 in the heading", "any heading", "arguments exchanged",
     [](FaultyLaw& law) { law.attitude_unit.sticks.heading = heading_from_east; }},
    {"cascade-idle-yaw-ignored", "sticks", Stage::sticks,
     "holds the yaw also at the lowest throttle", "throttle -1 and a heading that drifts",
     "a missing case",
     [](FaultyLaw& law) {
       change_lowest_throttle(law, [](Scalar, const StickGains&) { return false; });
     }},
    {"cascade-idle-yaw-below-0", "sticks", Stage::sticks, "takes any throttle below 0 for idle",
     "throttle -0.5 and a heading that drifts", "a wrong threshold",
     [](FaultyLaw& law) {
       change_lowest_throttle(law, [](Scalar throttle, const StickGains& gains) {
         return throttle < 0 && !gains.yaws_at_lowest_throttle;
       });
     }},
    {"cascade-idle-yaw-from-0.1", "sticks", Stage::sticks,
     "takes a throttle below 0.1 for idle, as if it began at 0",
     "throttle 0 and a heading that drifts", "another range",
     [](FaultyLaw& law) {
       change_lowest_throttle(law, [](Scalar throttle, const StickGains& gains) {
         return throttle < 0.1f && !gains.yaws_at_lowest_throttle;
       });
     }},
    {"cascade-airmode-ignored", "sticks", Stage::sticks, "does not read MC_AIRMODE",
     "MC_AIRMODE 2 at throttle -1", "a missing parameter",
     [](FaultyLaw& law) {
       change_lowest_throttle(law,
                              [](Scalar throttle, const StickGains&) { return throttle < -0.9f; });
     }},
    {"cascade-airmode-1-yaws", "sticks", Stage::sticks, "takes MC_AIRMODE 1 like 2",
     "MC_AIRMODE 1 at throttle -1", "flag comparison",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters& p) {
         gains.sticks.yaws_at_lowest_throttle = p.mc_airmode != 0;
       });
     }},
    {"cascade-heading-of-nose-down", "sticks", Stage::sticks,
     "takes the heading from q0 and q3 alone", "a large tilt", "a shortcut",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.heading = [](const Quat& q, const CascadeTraits&) {
         return cascade::wrap(2 * elementary::atan2(q[3], q[0]));
       };
     }},
    {"cascade-vtol-tilt-missing", "sticks", Stage::sticks,
     "does not turn the tilt of a VTOL into its present heading",
     "a VTOL with a yaw error and a tilt", "a missing step",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.tilt_for_yaw_error = [](const Quat& tilt, const Quat&,
                                                        const Quat&) { return tilt; };
     }},
    {"cascade-vtol-tilt-reversed", "sticks", Stage::sticks,
     "turns the tilt of a VTOL by the yaw error the other way",
     "a VTOL with a yaw error and a tilt", "a sign",
     [](FaultyLaw& law) {
       turn_tilt(law,
                 [](const Quat& tilt, const Quat& desired, const Quat& q_WB, const Quat& lean) {
                   const Quat yaw = product(cascade::inverse(lean), q_WB);
                   return product(product(cascade::inverse(yaw), desired), tilt);
                 });
     }},
    {"cascade-vtol-yaw-in-world", "sticks", Stage::sticks,
     "takes the yaw of a VTOL from the product in the other order",
     "a VTOL with a yaw error and a tilt", "factors exchanged",
     [](FaultyLaw& law) {
       turn_tilt(law,
                 [](const Quat& tilt, const Quat& desired, const Quat& q_WB, const Quat& lean) {
                   const Quat yaw = product(q_WB, cascade::inverse(lean));
                   return product(product(cascade::inverse(desired), yaw), tilt);
                 });
     }},
    {"cascade-vtol-tilt-for-all", "sticks", Stage::sticks,
     "turns the tilt of every vehicle like that of a VTOL", "a yaw error and a tilt",
     "a missing case",
     [](FaultyLaw& law) {
       also_before(law.attitude_unit, [](AttitudeIn& in) { in.vehicle_status.is_vtol = 1; });
       start_with(law.attitude_unit, ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS, [](AttitudeIn& in) {
         in.vehicle_status = {.armed_time = 0,
                              .armed = 0,
                              .is_rotary_wing = 1,
                              .is_vtol = 1,
                              .in_transition_mode = 0,
                              .is_vtol_tailsitter = 0};
       });
     }},
};

}  // namespace

std::span<const Fault> stick_faults() { return stick_list; }

}  // namespace attest::faults::in_cascade
