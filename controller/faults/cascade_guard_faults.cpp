// Mistakes of the attitude unit of the cascade with NaN, infinities, and quaternions whose norm is
// not 1.
#include <algorithm>
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using QuaternionLaw = QuaternionStages::Law;

// A NaN rate becomes the upper bound, because std::fmin and std::fmax ignore a NaN.
Vector limited_by_fmin(const Vector& rates, const QuaternionGains& gains) {
  Vector limited;
  for (int i = 0; i < 3; ++i) {
    const float max = gains.rate_max_rad_s[i];
    limited[i] = std::fmax(-max, std::fmin(rates[i], max));
  }
  return limited;
}

bool is_usable(const Quat& q) { return std::isfinite(q.sum()); }

// Drops an attitude setpoint that is not of norm 1, also one of the sticks.
void drop_other_norms(FaultyLaw& law) {
  auto usable = std::make_shared<bool>(true);  // the newest setpoint
  const auto judge = [usable](const Quat& q_WD) {
    const Scalar norm = cascade::squared_norm(q_WD);
    *usable = norm > 0.98f && norm < 1.02f;
  };
  auto& unit = law.attitude_unit;
  also_before(unit, [judge](AttitudeIn& in) {
    if ((in.updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT) == 0) return;
    judge(cascade::quaternion_from<Scalar>(in.vehicle_attitude_setpoint.q_d));
  });
  auto& desired = unit.sticks.desired_attitude;
  change_stage(desired, [judge](const auto& then, const Quat& yaw, const Quat& tilt) {
    const Quat q_WD = then(yaw, tilt);
    judge(q_WD);
    return q_WD;
  });
  change_stage(unit.step.is_newer,
               [usable](const auto& then, std::uint64_t now, std::uint64_t last) {
                 return *usable && then(now, last);
               });
}

const Fault guard_list[] = {
    {"cascade-acos-not-guarded", "robustness", Stage::guard,
     "does not clamp the arguments of acos and asin: NaN now and then",
     "a small yaw error, or an attitude of another norm", "a missing clamp",
     [](FaultyLaw& law) { law.attitude_unit.attitude.in_domain = [](Scalar x) { return x; }; }},
    {"cascade-attitude-normalised", "robustness", Stage::input, "normalises the attitude",
     "an attitude of another norm", "a helpful extra",
     [](FaultyLaw& law) {
       also_before(law.attitude_unit, [](AttitudeIn& in) {
         float(&q)[4] = in.vehicle_attitude.q;
         const Quat unit = cascade::unit(cascade::quaternion_from<Scalar>(q));
         for (int i = 0; i < 4; ++i) q[i] = unit[i];
       });
     }},
    {"cascade-setpoint-of-norm-1-only", "attitude", Stage::input,
     "drops an attitude setpoint that is not of norm 1", "a setpoint of another norm",
     "a helpful extra", drop_other_norms},
    {"cascade-inverse-is-conjugate", "robustness", Stage::tilt,
     "takes the conjugate of a quaternion for its inverse", "an attitude of another norm",
     "a shortcut",
     [](FaultyLaw& law) {
       const auto conjugate_product = [](const Quat& q, const Quat& p) {
         return cascade::canonical(cascade::product(Quat(q[0], -q[1], -q[2], -q[3]), p));
       };
       law.attitude_unit.attitude.remaining_yaw = conjugate_product;
       law.attitude_unit.attitude.error = conjugate_product;
     }},
    {"cascade-limit-drops-nan", "robustness", Stage::limit, "limits a rate that is NaN to a number",
     "an attitude of NaN", "order of arguments",
     [](FaultyLaw& law) { law.attitude_unit.attitude.limit = limited_by_fmin; }},
    {"cascade-setpoint-nan-dropped", "robustness", Stage::guard,
     "keeps the old attitude setpoint instead of one that is not finite",
     "an attitude setpoint of NaN", "a helpful extra",
     [](FaultyLaw& law) {
       change_stage(
           law.attitude_unit.attitude.setpoint,
           [last = cascade::identity<Scalar>()](const auto& then, const Quat& given) mutable {
             const Quat q = then(given);
             return is_usable(q) ? last = q : last;
           });
     }},
    {"cascade-setpoint-0-is-level", "robustness", Stage::guard,
     "takes an attitude setpoint of 0 for level", "an attitude setpoint of 0", "a guard too many",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.attitude.setpoint, [](const auto& then, const Quat& given) {
         return given.isZero(0) ? cascade::identity<Scalar>() : then(given);
       });
     }},
    {"cascade-reset-nan-ignored", "robustness", Stage::guard,
     "does not turn the setpoint by a delta_q_reset that is not finite", "a delta_q_reset of NaN",
     "a guard too many",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.attitude.adapted,
                    [](const auto& then, const Quat& delta, const Quat& q_WD) {
                      return is_usable(delta) ? then(delta, q_WD) : q_WD;
                    });
     }},
    {"cascade-rates-nan-is-0", "robustness", Stage::guard, "publishes rates of 0 instead of NaN",
     "an attitude of NaN", "a guard too many",
     [](FaultyLaw& law) {
       also_after(law.attitude_unit, [](const AttitudeIn&, AttitudeOut& out) {
         auto& rates = out.vehicle_rates_setpoint;
         for (float* rate : {&rates.roll, &rates.pitch, &rates.yaw}) {
           if (!std::isfinite(*rate)) *rate = 0;
         }
       });
     }},
    {"cascade-stick-nan-is-0", "robustness", Stage::guard, "takes a stick of NaN for centred",
     "a stick of NaN", "a guard too many",
     [](FaultyLaw& law) {
       also_before(law.attitude_unit, [](AttitudeIn& in) {
         auto& sticks = in.manual_control_setpoint;
         for (float* stick : {&sticks.roll, &sticks.pitch, &sticks.yaw}) {
           if (std::isnan(*stick)) *stick = 0;
         }
       });
     }},
};

}  // namespace

std::span<const Fault> guard_faults() { return guard_list; }

}  // namespace attest::faults::in_cascade
