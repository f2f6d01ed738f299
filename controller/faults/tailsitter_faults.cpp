// Wrong recoveries of a tailsitter.
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using Stages = RecoveryStages::Law;

template <typename Change>
void change_tilt(FaultyLaw& law, Change change) {
  change_stage(law.recovery.tilt,
               [change](const auto& then, const Quaternion& q, const Quaternion& q_sp) {
                 RecoveryTilt tilt = then(q, q_sp);
                 change(tilt);
                 return tilt;
               });
}

template <typename Change>
void change_optimal(FaultyLaw& law, Change change) {
  change_stage(law.recovery.optimal_rates, [change](const auto& then, const RecoveryTilt& tilt) {
    Vector rates = then(tilt);
    change(rates);
    return rates;
  });
}

const Fault tailsitter_list[] = {
    {"recovery-never", "tailsitter", Stage::recovery, "flies the quaternion law at every tilt",
     "a tilt beyond 30 deg", "a missing step",
     [](FaultyLaw& law) { law.recovery.latch = [](bool, float) { return false; }; }},
    {"recovery-always", "tailsitter", Stage::recovery, "recovers at every tilt",
     "a tilt below 5 deg", "wrong branch",
     [](FaultyLaw& law) { law.recovery.latch = [](bool, float) { return true; }; }},
    {"recovery-no-latch", "tailsitter", Stage::recovery, "recovers above 30 deg only",
     "a recovery between 30 and 5 deg", "a latch",
     [](FaultyLaw& law) {
       law.recovery.latch = [](bool, float tilt) { return tilt > mc_att_control::radians(30.0f); };
     }},
    {"recovery-from-5", "tailsitter", Stage::recovery, "recovers above 5 deg",
     "a tilt between 5 and 30 deg", "wrong branch threshold",
     [](FaultyLaw& law) {
       law.recovery.latch = [](bool, float tilt) { return tilt > mc_att_control::radians(5.0f); };
     }},
    {"recovery-for-good", "tailsitter", Stage::recovery, "never ends a recovery",
     "a recovery below 5 deg", "a latch",
     [](FaultyLaw& law) {
       law.recovery.latch = [](bool now, float tilt) {
         return now || tilt > mc_att_control::radians(30.0f);
       };
     }},
    {"recovery-in-degrees", "tailsitter", Stage::recovery, "compares radians with 30 and 5",
     "a tilt beyond 30 deg", "degrees",
     [](FaultyLaw& law) {
       law.recovery.latch = [](bool now, float tilt) {
         return tilt > 30 ? true : (tilt < 5 ? false : now);
       };
     }},
    {"recovery-unfolded", "tailsitter", Stage::recovery, "does not undo the folding",
     "tilts about all axes", "a missing step",
     [](FaultyLaw& law) {
       change_tilt(law, [](RecoveryTilt& tilt) { tilt.signs = Vector::Ones(); });
     }},
    {"recovery-sign-yaw", "tailsitter", Stage::recovery, "has yaw's sign wrong in the folding",
     "tilts about all axes", "a sign",
     [](FaultyLaw& law) {
       change_tilt(law, [](RecoveryTilt& tilt) { tilt.signs[2] = -tilt.signs[2]; });
     }},
    {"recovery-atan2-exchanged", "tailsitter", Stage::recovery, "exchanges the arguments of atan2",
     "a tilt about pitch or roll alone", "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt(law, [](RecoveryTilt& tilt) {
         tilt.direction_rad = 1.57079632679f - tilt.direction_rad;
       });
     }},
    {"recovery-pitch-not-1.5", "tailsitter", Stage::recovery, "leaves out the factor 1.5 on pitch",
     "a recovery", "a missing factor",
     [](FaultyLaw& law) { change_optimal(law, [](Vector& rates) { rates[1] /= 1.5f; }); }},
    {"recovery-reversed", "tailsitter", Stage::recovery, "does not negate the optimal rates",
     "a recovery", "a sign",
     [](FaultyLaw& law) { change_optimal(law, [](Vector& rates) { rates = -rates; }); }},
    {"recovery-roll-pitch", "tailsitter", Stage::recovery, "exchanges roll and pitch", "a recovery",
     "wrong axis",
     [](FaultyLaw& law) {
       change_optimal(law, [](Vector& rates) { std::swap(rates[0], rates[1]); });
     }},
    {"recovery-unlimited", "tailsitter", Stage::limit, "does not limit the rates",
     "a recovery with low limits", "missing clamp",
     [](FaultyLaw& law) {
       law.recovery.limit = [](const Vector& rates, const AttitudeGains&) { return rates; };
     }},
    {"recovery-auto-limit", "tailsitter", Stage::limit, "uses the autonomous limits",
     "a large yaw rate", "wrong branch",
     [](FaultyLaw& law) {
       law.recovery.limit = [](const Vector& rates, const AttitudeGains& gains) {
         return mc_att_control::clamp_each<float>(rates, gains.auto_rate_max_rad_s);
       };
     }},
    {"recovery-yaw-unclamped", "tailsitter", Stage::recovery, "does not clamp yaw to 1 rad/s",
     "a large yaw error below 5 deg of tilt", "missing clamp",
     [](FaultyLaw& law) {
       change_stage(
           law.recovery.quaternion_rates, [](const auto& then, const Quaternion& q,
                                             const Quaternion& q_sp, const AttitudeGains& gains) {
             Vector rates = then(q, q_sp, gains);
             const Quaternion e = mc_att_control::product(mc_att_control::conjugate(q_sp), q);
             rates[2] = gains.proportional_1_s[2] * e.z() * (e.w() > 0 ? -2.0f : 2.0f);
             return rates;
           });
     }},
    {"recovery-longer-way", "tailsitter", Stage::recovery, "ignores the sign of w",
     "the other quaternion of an attitude", "quaternion order",
     [](FaultyLaw& law) {
       law.recovery.quaternion_rates = [](const Quaternion& q, const Quaternion& q_sp,
                                          const AttitudeGains& gains) {
         const Quaternion e = mc_att_control::product(mc_att_control::conjugate(q_sp), q);
         Vector rates =
             gains.proportional_1_s.cwiseProduct(mc_att_control::imaginary_part(e)) * -2.0f;
         rates[2] = mc_att_control::clamp(rates[2], -1.0f, 1.0f);
         return rates;
       };
     }},
    {"recovery-ff-unweighted", "tailsitter", Stage::feed_forward,
     "does not weigh the yaw feed-forward", "a commanded yaw rate while tilted", "wrong weight",
     [](FaultyLaw& law) {
       law.recovery.yaw_feed_forward = [](float yaw, float rate, const Quaternion&,
                                          const AttitudeGains& gains) {
         return yaw + rate * gains.yaw_feed_forward;
       };
     }},
    {"recovery-ff-signed", "tailsitter", Stage::feed_forward,
     "allows a negative weight of the feed-forward", "a commanded yaw rate upside down",
     "missing clamp",
     [](FaultyLaw& law) {
       law.recovery.yaw_feed_forward = [](float yaw, float rate, const Quaternion& q,
                                          const AttitudeGains& gains) {
         return yaw + rate * mc_att_control::rotation_matrix(q)(2, 2) * gains.yaw_feed_forward;
       };
     }},
};

}  // namespace

std::span<const Fault> tailsitter_faults() { return tailsitter_list; }

}  // namespace attest::faults
