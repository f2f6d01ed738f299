// Mistakes of both units of the cascade in signals: the sign or axes of one signal, a quaternion
// that is read in another order, and few bits.
#include <algorithm>
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

// Changes the published torque.
template <typename Change>
void change_published_torque(FaultyLaw& law, Change change) {
  also_after(law.rate_unit, [change](const RateIn&, RateOut& out) {
    if (out.vehicle_torque_setpoint.published != 0) change(out.vehicle_torque_setpoint.xyz);
  });
}

template <int axis>
void reverse_torque(FaultyLaw& law) {
  change_published_torque(law, [](float(&torque)[3]) { torque[axis] = -torque[axis]; });
}

template <int axis>
void reverse_rate(FaultyLaw& law) {
  change_stage(law.attitude_unit.attitude.proportional,
               [](const auto& then, const Quat& error, const QuaternionGains& gains) {
                 Vector rates = then(error, gains);
                 rates[axis] = -rates[axis];
                 return rates;
               });
}

// Changes the quaternion of the attitude, or that of the setpoint.
template <typename Change>
void change_attitude(FaultyLaw& law, Change change) {
  also_before(law.attitude_unit, [change](AttitudeIn& in) { change(in.vehicle_attitude.q); });
}
template <typename Change>
void change_setpoint(FaultyLaw& law, Change change) {
  also_before(law.attitude_unit,
              [change](AttitudeIn& in) { change(in.vehicle_attitude_setpoint.q_d); });
}

void from_xyzw(float (&q)[4]) { std::rotate(q, q + 1, q + 4); }

void conjugate(float (&q)[4]) {
  for (int i = 1; i < 4; ++i) q[i] = -q[i];
}

// Rounds to a multiple of 1 / steps.
template <std::size_t size>
void round_to(float steps, float (&values)[size]) {
  for (float& value : values) value = std::round(value * steps) / steps;
}

const Fault signal_list[] = {
    {"cascade-quat-order-attitude", "attitude", Stage::input,
     "takes the quaternion of the attitude as x, y, z, w", "any attitude", "quaternion order",
     [](FaultyLaw& law) { change_attitude(law, from_xyzw); }},
    {"cascade-quat-order-setpoint", "attitude", Stage::input,
     "takes the quaternion of the setpoint as x, y, z, w", "any setpoint", "quaternion order",
     [](FaultyLaw& law) { change_setpoint(law, from_xyzw); }},
    {"cascade-attitude-conjugated", "attitude", Stage::input,
     "takes the attitude as a rotation of the world into the body", "a tilt or a yaw",
     "transposed rotation", [](FaultyLaw& law) { change_attitude(law, conjugate); }},
    {"cascade-setpoint-conjugated", "attitude", Stage::input,
     "takes the setpoint as a rotation of the world into the body", "a tilt or a yaw",
     "transposed rotation", [](FaultyLaw& law) { change_setpoint(law, conjugate); }},
    {"cascade-attitude-in-12-bits", "attitude", Stage::input, "holds quaternions in 12 bits",
     "any attitude", "fixed point",
     [](FaultyLaw& law) {
       change_attitude(law, [](float(&q)[4]) { round_to(2048, q); });
       change_setpoint(law, [](float(&q)[4]) { round_to(2048, q); });
     }},
    {"cascade-roll-reversed", "attitude", Stage::p, "reverses roll", "a roll error", "a sign",
     reverse_rate<0>},
    {"cascade-yaw-reversed", "attitude", Stage::p, "reverses yaw", "a yaw error", "a sign",
     reverse_rate<2>},
    {"cascade-limit-lower-only", "rate_limit", Stage::limit, "limits negative rates only",
     "a large positive error", "a missing clamp",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.limit = [](const Vector& rates, const QuaternionGains& gains) {
         return Vector(rates.cwiseMax(-gains.rate_max_rad_s));
       };
     }},
    {"cascade-gyro-yaw-reversed", "rates", Stage::input, "takes the yaw rate of the gyro as in FLU",
     "a yaw rate", "another frame",
     [](FaultyLaw& law) {
       also_before(law.rate_unit, [](RateIn& in) {
         float& yaw = in.vehicle_angular_velocity.xyz[2];
         yaw = -yaw;
       });
     }},
    {"cascade-gyro-in-10-bits", "rates", Stage::input, "holds body rates in 10 bits", "any rate",
     "fixed point",
     [](FaultyLaw& law) {
       also_before(law.rate_unit,
                   [](RateIn& in) { round_to(64, in.vehicle_angular_velocity.xyz); });
     }},
    {"cascade-torque-axes-exchanged", "rates", Stage::output,
     "exchanges the torque of roll and pitch", "torques that differ", "wrong axis",
     [](FaultyLaw& law) {
       change_published_torque(law, [](float(&torque)[3]) { std::swap(torque[0], torque[1]); });
     }},
    {"cascade-pitch-torque-reversed", "rates", Stage::output,
     "has the sign of the pitch torque wrong", "a pitch torque", "a sign", reverse_torque<1>},
    {"cascade-yaw-torque-reversed", "rates", Stage::output, "has the sign of the yaw torque wrong",
     "a yaw torque", "a sign", reverse_torque<2>},
    {"cascade-torque-in-8-bits", "rates", Stage::output, "holds torques in 8 bits", "any torque",
     "fixed point",
     [](FaultyLaw& law) {
       change_published_torque(law, [](float(&torque)[3]) { round_to(128, torque); });
     }},
    {"cascade-integral-in-12-bits", "rates", Stage::i, "holds the integral in 12 bits",
     "an error that lasts", "fixed point",
     [](FaultyLaw& law) {
       change_stage(law.rate_unit.rate.limited,
                    [](const auto& then, Scalar next, Scalar before, Scalar max) {
                      return std::round(then(next, before, max) * 4096) / 4096;
                    });
     }},
    {"cascade-integral-decays", "rates", Stage::i, "leaks the integral", "an error that lasts",
     "a helpful extra",
     [](FaultyLaw& law) {
       change_stage(law.rate_unit.rate.limited,
                    [](const auto& then, Scalar next, Scalar before, Scalar max) {
                      return then(next, before, max) * 0.999f;
                    });
     }},
    {"cascade-gains-in-8-bits", "parameters", Stage::parameters, "holds the rate gains in 8 bits",
     "any gain", "fixed point",
     [](FaultyLaw& law) {
       change_gains(law.rate_unit, [](RateUnitGains& gains, const CascadeParameters&) {
         for (Vector* gain :
              {&gains.rate.proportional, &gains.rate.integral, &gains.rate.derivative}) {
           for (int i = 0; i < 3; ++i) (*gain)[i] = std::round((*gain)[i] * 256) / 256;
         }
       });
     }},
};

}  // namespace

std::span<const Fault> signal_faults() { return signal_list; }

}  // namespace attest::faults::in_cascade
