// Wrong terms of the rate law of the cascade: P, D, feed-forward, the sum, the shape of the
// integral.
#include <algorithm>
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using RateLaw = TorqueStages::Law;

// Changes the terms of the torque before they are added. Change is void(p, i, d, ff).
template <typename Change>
void change_terms(FaultyLaw& law, Change change) {
  change_stage(law.rate_unit.rate.torque,
               [change](const auto& then, Vector p, Vector i, Vector d, Vector ff) {
                 change(p, i, d, ff);
                 return then(p, i, d, ff);
               });
}

template <typename Change>
void change_rate_gains(FaultyLaw& law, Change change) {
  change_gains(law.rate_unit, [change](RateUnitGains& gains, const CascadeParameters& p) {
    change(gains.rate, p);
  });
}

Vector k_of(const CascadeParameters& p) {
  return cascade::each<Scalar>(p.mc_rollrate_k, p.mc_pitchrate_k, p.mc_yawrate_k);
}

// Watches `value` in this step and in the one before, and dt. Value is Vector(rates_sp, rates).
template <typename Value>
auto watch_change(FaultyLaw& law, Value value) {
  struct Seen {
    Vector now = Vector::Zero(), last = Vector::Zero();
    float dt_s = 0.02f;
  };
  auto seen = std::make_shared<Seen>();
  change_stage(law.rate_unit.step.step_time,
               [seen](const auto& then, std::uint64_t now_us, std::uint64_t last_us) {
                 return seen->dt_s = then(now_us, last_us);
               });
  change_stage(law.rate_unit.rate.error,
               [seen, value](const auto& then, const Vector& rates_sp, const Vector& rates) {
                 seen->last = std::exchange(seen->now, value(rates_sp, rates));
                 return then(rates_sp, rates);
               });
  return seen;
}

// D acts on the change of `value` since the previous step.
template <typename Value>
void differentiate(FaultyLaw& law, Value value) {
  change_stage(law.rate_unit.rate.derivative,
               [seen = watch_change(law, value)](const auto& then, V, const TorqueGains& gains) {
                 return then(Vector((seen->now - seen->last) / seen->dt_s), gains);
               });
}

// The integral grows as if each step took `dt_s`.
void integrate_with(FaultyLaw& law, float dt_s) {
  change_stage(law.rate_unit.rate.integrated,
               [dt_s](const auto& then, Scalar integral, Scalar factor, Scalar gain, Scalar error,
                      Scalar) { return then(integral, factor, gain, error, dt_s); });
}

template <typename Factor>
void change_i_factor(FaultyLaw& law, Factor factor) {
  law.rate_unit.rate.i_factor = factor;
}

float share_of(float error, float max_rad_s) {
  const float share = error / max_rad_s;
  return std::max(0.0f, 1 - share * share);
}

const Fault torque_list[] = {
    {"cascade-d-of-gyro", "rates", Stage::d,
     "takes D from the difference of two gyro samples, not from xyz_derivative", "any acceleration",
     "another signal",
     [](FaultyLaw& law) { differentiate(law, [](V, V rates) { return Vector(rates); }); }},
    {"cascade-d-of-error", "rates", Stage::d, "takes D from the change of the error",
     "a setpoint that changes", "another signal",
     [](FaultyLaw& law) { differentiate(law, [](V sp, V rates) { return Vector(rates - sp); }); }},
    {"cascade-d-reversed", "rates", Stage::d, "adds D instead of subtracting it",
     "any acceleration", "a sign",
     [](FaultyLaw& law) {
       change_terms(law, [](Vector&, Vector&, Vector& d, Vector&) { d *= -1; });
     }},
    {"cascade-d-missing", "rates", Stage::d, "has no D", "any acceleration", "a missing term",
     [](FaultyLaw& law) {
       change_terms(law, [](Vector&, Vector&, Vector& d, Vector&) { d.setZero(); });
     }},
    {"cascade-p-missing", "rates", Stage::p, "has no P", "any rate error", "a missing term",
     [](FaultyLaw& law) {
       change_terms(law, [](Vector& p, Vector&, Vector&, Vector&) { p.setZero(); });
     }},
    {"cascade-d-of-gyro-without-dt", "rates", Stage::d,
     "takes D from the difference of two gyro samples, and does not divide it by dt",
     "any acceleration", "a missing factor",
     [](FaultyLaw& law) {
       const auto rates = [](V, V now) { return Vector(now); };
       change_stage(
           law.rate_unit.rate.derivative,
           [seen = watch_change(law, rates)](const auto& then, V, const TorqueGains& gains) {
             return then(Vector(seen->now - seen->last), gains);
           });
     }},
    {"cascade-d-filtered", "rates", Stage::d, "low-passes D", "an acceleration that changes",
     "a helpful extra",
     [](FaultyLaw& law) {
       change_stage(law.rate_unit.rate.derivative,
                    [filtered = Vector(Vector::Zero())](const auto& then, V acceleration,
                                                        const TorqueGains& gains) mutable {
                      filtered += 0.5f * (then(acceleration, gains) - filtered);
                      return filtered;
                    });
     }},
    {"cascade-i-without-dt", "rates", Stage::i, "does not multiply by dt", "an error that lasts",
     "a missing factor", [](FaultyLaw& law) { integrate_with(law, 1); }},
    {"cascade-i-fixed-dt", "rates", Stage::i, "integrates as if every step took 4 ms",
     "any rate except 250 Hz", "a fixed rate", [](FaultyLaw& law) { integrate_with(law, 0.004f); }},
    {"cascade-i-reversed", "rates", Stage::i, "subtracts the integral", "an error that lasts",
     "a sign",
     [](FaultyLaw& law) {
       change_terms(law, [](Vector&, Vector& i, Vector&, Vector&) { i *= -1; });
     }},
    {"cascade-i-missing", "rates", Stage::i, "does not add the integral", "an error that lasts",
     "a missing term",
     [](FaultyLaw& law) {
       change_terms(law, [](Vector&, Vector& i, Vector&, Vector&) { i.setZero(); });
     }},
    {"cascade-i-never", "rates", Stage::i, "has no integral: it stays 0", "an error that lasts",
     "a missing term",
     [](FaultyLaw& law) { law.rate_unit.rate.may_integrate = [](bool, bool) { return false; }; }},
    {"cascade-rates-setpoint-late", "rates", Stage::latching,
     "uses the rates setpoint one step late", "a setpoint that changes", "one-tick delay",
     [](FaultyLaw& law) {
       delay<&RateIn::vehicle_rates_setpoint, ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT>(
           law.rate_unit);
     }},
    {"cascade-i-of-this-step", "rates", Stage::i, "adds the integral after this step's update",
     "any error", "steps exchanged",
     [](FaultyLaw& law) {
       law.rate_unit.rate.in_torque = [](V, V after) { return Vector(after); };
     }},
    {"cascade-ff-missing", "rates", Stage::ff, "has no feed-forward", "a feed-forward gain",
     "a missing term",
     [](FaultyLaw& law) {
       change_terms(law, [](Vector&, Vector&, Vector&, Vector& ff) { ff.setZero(); });
     }},
    {"cascade-ff-reversed", "rates", Stage::ff, "subtracts the feed-forward", "a feed-forward gain",
     "a sign",
     [](FaultyLaw& law) {
       change_terms(law, [](Vector&, Vector&, Vector&, Vector& ff) { ff *= -1; });
     }},
    {"cascade-ff-with-k", "rates", Stage::ff, "multiplies the feed-forward by K, too",
     "a feed-forward gain and a K other than 1", "a misplaced factor",
     [](FaultyLaw& law) {
       change_rate_gains(law, [](TorqueGains& gains, const CascadeParameters& p) {
         gains.feed_forward = gains.feed_forward.cwiseProduct(k_of(p)).eval();
       });
     }},
    {"cascade-ff-of-error", "rates", Stage::ff, "feeds the error forward, not the setpoint",
     "a feed-forward gain and a rate", "another signal",
     [](FaultyLaw& law) {
       auto error = std::make_shared<Vector>(Vector::Zero());
       change_stage(law.rate_unit.rate.error,
                    [error](const auto& then, V sp, V rates) { return *error = then(sp, rates); });
       change_stage(
           law.rate_unit.rate.feed_forward,
           [error](const auto& then, V, const TorqueGains& gains) { return then(*error, gains); });
     }},
    {"cascade-ff-of-change", "rates", Stage::ff,
     "feeds the change of the setpoint forward, as v1.3.4 does", "a feed-forward gain",
     "another version of the law",
     [](FaultyLaw& law) {
       const auto setpoint = [](V sp, V) { return Vector(sp); };
       change_stage(
           law.rate_unit.rate.feed_forward,
           [seen = watch_change(law, setpoint)](const auto& then, V, const TorqueGains& gains) {
             return then(Vector((seen->now - seen->last) / seen->dt_s), gains);
           });
     }},
    {"cascade-k-on-p-only", "rates", Stage::parameters, "multiplies P alone by K",
     "a K other than 1", "a missing factor",
     [](FaultyLaw& law) {
       change_rate_gains(law, [](TorqueGains& gains, const CascadeParameters& p) {
         gains.integral = cascade::each<Scalar>(p.mc_rollrate_i, p.mc_pitchrate_i, p.mc_yawrate_i);
         gains.derivative =
             cascade::each<Scalar>(p.mc_rollrate_d, p.mc_pitchrate_d, p.mc_yawrate_d);
       });
     }},
    {"cascade-k-not-on-d", "rates", Stage::parameters, "does not multiply D by K",
     "a K other than 1 and an acceleration", "a missing factor",
     [](FaultyLaw& law) {
       change_rate_gains(law, [](TorqueGains& gains, const CascadeParameters& p) {
         gains.derivative =
             cascade::each<Scalar>(p.mc_rollrate_d, p.mc_pitchrate_d, p.mc_yawrate_d);
       });
     }},
    {"cascade-k-not-on-i", "rates", Stage::parameters, "does not multiply the integral gain by K",
     "a K other than 1 and an error that lasts", "a missing factor",
     [](FaultyLaw& law) {
       change_rate_gains(law, [](TorqueGains& gains, const CascadeParameters& p) {
         gains.integral = cascade::each<Scalar>(p.mc_rollrate_i, p.mc_pitchrate_i, p.mc_yawrate_i);
       });
     }},
    {"cascade-k-divides", "rates", Stage::parameters, "divides by K", "a K other than 1",
     "an inverse factor",
     [](FaultyLaw& law) {
       change_rate_gains(law, [](TorqueGains& gains, const CascadeParameters& p) {
         const Vector k = k_of(p).cwiseProduct(k_of(p));
         gains.proportional = gains.proportional.cwiseQuotient(k).eval();
         gains.integral = gains.integral.cwiseQuotient(k).eval();
         gains.derivative = gains.derivative.cwiseQuotient(k).eval();
       });
     }},
    {"cascade-rate-error-reversed", "rates", Stage::p, "takes the error with the other sign",
     "any rate error", "a sign",
     [](FaultyLaw& law) {
       law.rate_unit.rate.error = [](V sp, V rates) { return Vector(rates - sp); };
     }},
    {"cascade-rate-in-degrees", "rates", Stage::input, "takes the gyro in deg/s", "any rate",
     "degrees",
     [](FaultyLaw& law) {
       law.rate_unit.rate.error = [](V sp, V rates) { return Vector(sp - rates * 0.0174532924f); };
     }},
    {"cascade-gyro-from-flu", "rates", Stage::input, "takes the gyro in body axes FLU",
     "a pitch or yaw rate", "another frame",
     [](FaultyLaw& law) {
       also_before(law.rate_unit, [](RateIn& in) {
         float(&xyz)[3] = in.vehicle_angular_velocity.xyz;
         xyz[1] = -xyz[1], xyz[2] = -xyz[2];
       });
     }},
    {"cascade-gyro-axes-exchanged", "rates", Stage::input, "exchanges roll and pitch of the gyro",
     "a roll rate", "wrong axis",
     [](FaultyLaw& law) {
       also_before(law.rate_unit, [](RateIn& in) {
         float(&xyz)[3] = in.vehicle_angular_velocity.xyz;
         std::swap(xyz[0], xyz[1]);
       });
     }},
    {"cascade-torque-clamped", "rates", Stage::output, "clamps the torque to -1 .. 1",
     "a large error", "a helpful extra",
     [](FaultyLaw& law) {
       change_stage(law.rate_unit.rate.torque, [](const auto& then, V p, V i, V d, V ff) {
         return Vector(then(p, i, d, ff).cwiseMax(-1.0f).cwiseMin(1.0f));
       });
     }},
    {"cascade-rate-thrust-z-only", "rates", Stage::output,
     "publishes the z component of the thrust only", "a setpoint with thrust along x or y",
     "a missing axis",
     [](FaultyLaw& law) {
       also_after(law.rate_unit, [](const RateIn&, RateOut& out) {
         out.vehicle_thrust_setpoint.xyz[0] = out.vehicle_thrust_setpoint.xyz[1] = 0;
       });
     }},
    {"cascade-rate-thrust-up", "rates", Stage::output, "publishes the thrust as positive up",
     "any thrust", "a sign",
     [](FaultyLaw& law) {
       also_after(law.rate_unit, [](const RateIn&, RateOut& out) {
         float& thrust = out.vehicle_thrust_setpoint.xyz[2];
         if (out.vehicle_thrust_setpoint.published != 0) thrust = -thrust;
       });
     }},
    {"cascade-i-factor-missing", "i_factor", Stage::i, "integrates the whole error",
     "an error of 200 deg/s", "a missing factor",
     [](FaultyLaw& law) { change_i_factor(law, [](Scalar) { return 1.0f; }); }},
    {"cascade-i-factor-of-7", "i_factor", Stage::i, "takes 400 deg/s as 7 rad/s",
     "an error of 350 deg/s", "a rounded constant",
     [](FaultyLaw& law) { change_i_factor(law, [](Scalar e) { return share_of(e, 7.0f); }); }},
    {"cascade-i-factor-of-400", "i_factor", Stage::i, "takes 400 deg/s as 400 rad/s",
     "an error of 200 deg/s", "degrees",
     [](FaultyLaw& law) { change_i_factor(law, [](Scalar e) { return share_of(e, 400.0f); }); }},
    {"cascade-i-factor-of-200", "i_factor", Stage::i, "ends the integral at 200 deg/s",
     "an error of 100 deg/s", "a wrong constant",
     [](FaultyLaw& law) {
       change_i_factor(law, [](Scalar e) { return share_of(e, 3.49065852f); });
     }},
    {"cascade-i-factor-linear", "i_factor", Stage::i, "does not square the error in the factor",
     "an error of 200 deg/s", "a missing square",
     [](FaultyLaw& law) {
       change_i_factor(law, [](Scalar e) { return std::max(0.0f, 1 - std::abs(e) / 6.98131704f); });
     }},
    {"cascade-i-factor-negative", "i_factor", Stage::i,
     "lets the factor become negative from 400 deg/s on", "an error of 500 deg/s",
     "a missing clamp",
     [](FaultyLaw& law) {
       change_i_factor(law, [](Scalar e) {
         const Scalar share = e / 6.98131704f;
         return 1 - share * share;
       });
     }},
    {"cascade-i-factor-switches", "i_factor", Stage::i,
     "integrates the whole error up to 400 deg/s", "an error of 200 deg/s", "another curve",
     [](FaultyLaw& law) {
       change_i_factor(law, [](Scalar e) { return std::abs(e) < 6.98131704f ? 1.0f : 0.0f; });
     }},
    {"cascade-i-factor-twice", "i_factor", Stage::i, "applies the factor twice",
     "an error of 200 deg/s", "a factor twice",
     [](FaultyLaw& law) {
       change_i_factor(law, [](Scalar e) { return RateLaw::i_factor(e) * RateLaw::i_factor(e); });
     }},
};

}  // namespace

std::span<const Fault> torque_faults() { return torque_list; }

}  // namespace attest::faults::in_cascade
