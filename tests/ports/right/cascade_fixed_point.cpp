// The cascade in fixed point: attitudes, angles, rates, torques, integrals and thrust. It cannot
// represent values that are not finite, and declares the group robustness as not supported. Where
// the law uses NaN as "none", it uses the lowest number.
//
// Four things keep 22 fraction bits near enough to the law:
// - Sums of squares have 128 bits and are rounded once.
// - A quaternion is normalised by a norm with more bits, because it is short near a half turn.
// - A low-pass has a state with twice the bits. Otherwise a slow filter stops before it reaches its
//   input, and the yaw is never locked.
// - dt is a whole number of microseconds, kept in the last bits: 125 us in s are only 524 last
// bits.
//
// Must pass at the numeric level. With 32 fraction bits it is judged like any port. With 22 it
// declares its arithmetic and is judged as fixed point.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/ports/right/fixed.hpp"
// The scalar type must be complete first.
#include "tests/ports/cascade_port.hpp"

// The sum of the products of two vectors, of 2 * fraction_bits.
template <typename Vector>
Fixed::Wide accumulated(const Vector& a, const Vector& b) {
  Fixed::Wide sum = 0;
  for (int i = 0; i < a.size(); ++i) sum += a[i].raw() * b[i].raw();
  return sum;
}

inline Fixed rounded(Fixed::Wide accumulated) {
  constexpr Fixed::Wide half = Fixed::Wide{1} << (Fixed::fraction_bits - 1);
  return Fixed::of_raw((accumulated + half) >> Fixed::fraction_bits);
}

template <>
inline Fixed attest::mc_att_control::ordered::dot(const Vector3<Fixed>& a,
                                                  const Vector3<Fixed>& b) {
  return rounded(accumulated(a, b));
}

template <>
inline Fixed attest::mc_att_control::ordered::length(const Vector3<Fixed>& v) {
  return Fixed::of_raw(root_of(accumulated(v, v)));
}

template <>
inline Fixed attest::cascade::squared_norm(const Quaternion<Fixed>& q) {
  return rounded(accumulated(q, q));
}

template <>
inline attest::cascade::Quaternion<Fixed> attest::cascade::unit(const Quaternion<Fixed>& q) {
  constexpr int more_bits = 12;
  const Fixed::Wide norm = root_of(accumulated(q, q) << (2 * more_bits));
  if (norm == 0) return {Fixed(0), Fixed(0), Fixed(0), Fixed(0)};
  Quaternion<Fixed> result;
  for (int i = 0; i < 4; ++i) {
    const Fixed::Wide scaled = q[i].raw() * (Fixed::Wide{1} << (Fixed::fraction_bits + more_bits));
    result[i] = Fixed::of_raw((scaled + (scaled < 0 ? -norm : norm) / 2) / norm);
  }
  return result;
}

constexpr int us_in_s = 1000000;

// rate * dt.
inline Fixed change(Fixed rate, Fixed dt_us) {
  const Fixed::Wide product = rate.raw() * dt_us.raw();
  return Fixed::of_raw((product + (product < 0 ? -us_in_s : us_in_s) / 2) / us_in_s);
}

// The two forms of the law are the same here.
template <>
struct attest::cascade::LowPass<Fixed> {
  Fixed state;
  Fixed weight;
  Fixed::Wide rest = 0;  // of 2 * fraction_bits, at most half of the state's last bit

  Fixed update(Fixed tau_s, Fixed dt_us, Fixed input, const ProfileTraits&) {
    constexpr Fixed::Wide one = Fixed::Wide{1} << Fixed::fraction_bits;
    const Fixed::Wide dt = dt_us.raw() * one;
    weight = Fixed::of_raw(dt * one / (tau_s.raw() * us_in_s + dt));
    rest += (weight.raw() * ((input - state).raw() * one - rest)) >> Fixed::fraction_bits;
    const Fixed step = rounded(rest);
    rest -= step.raw() * one;
    return state += step;
  }
};

template <>
inline Fixed attest::cascade::slewed(Fixed value, Fixed rate, Fixed dt_us, Fixed target) {
  const Fixed step = change(rate, dt_us);
  return value + clamp(target - value, -step, step);
}

namespace {

using namespace attest::cascade;
using Vector = Vector3<Fixed>;

Vector fixed(const Vector3<float>& v) { return {Fixed(v[0]), Fixed(v[1]), Fixed(v[2])}; }

// The clamped difference, in the last bits.
Fixed microseconds(std::uint64_t difference_us, std::uint64_t least_us) {
  return Fixed::of_raw(std::clamp<std::uint64_t>(difference_us, least_us, 20000));
}

struct AttitudeStep : AttitudeStepStages<Fixed> {
  static Fixed step_time(std::uint64_t sample_us, std::uint64_t last_us) {
    return microseconds(sample_us - last_us, 200);
  }

  static bool is_spooled(std::uint64_t now_us, const Status& status, Fixed spoolup_us) {
    return status.armed != 0 && Fixed(static_cast<double>(now_us - status.armed_time)) > spoolup_us;
  }

  // Parameters are converted where they are set, by the ground station or the start-up code.
  static AttitudeUnitGains<Fixed> gains(const Parameters& parameters) {
    const auto from = attitude_unit_gains<float>(parameters);
    AttitudeUnitGains<Fixed> to;
    to.attitude = {fixed(from.attitude.proportional_1_s), fixed(from.attitude.rate_max_rad_s),
                   Fixed(from.attitude.yaw_weight)};
    const StickGains<float>& sticks = from.sticks;
    to.sticks = {
        Fixed(sticks.tilt_max_rad), Fixed(sticks.tilt_tau_s),      Fixed(sticks.yaw_rate_max_rad_s),
        Fixed(sticks.yaw_tau_s),    Fixed(sticks.yaw_deadzone),    Fixed(sticks.yaw_expo),
        Fixed(sticks.thrust_min),   Fixed(sticks.thrust_hover),    Fixed(sticks.thrust_max),
        sticks.throttle_curve,      sticks.yaws_at_lowest_throttle};
    to.spoolup_us = Fixed(from.spoolup_us);
    to.model = {Fixed(from.model.natural_rad_s), Fixed(from.model.feed_forward),
                Fixed(from.model.feed_forward_max_rad_s)};
    return to;
  }
};

// The yaw rate is rounded, so it is above 2^-23 if it is more than the bits of 2^-23 that fit: with
// 22 fraction bits, if it is not 0.
bool is_commanded(Fixed yaw_rate) {
  constexpr Fixed threshold = Fixed::of_raw((Fixed::Wide{1} << Fixed::fraction_bits) >> 23);
  return abs(yaw_rate) > threshold;
}

struct Sticks : StickStages<Fixed> {
  static Fixed locked_yaw(Fixed yaw_sp, Fixed rate, Fixed heading, Fixed old_correction,
                          Fixed correction) {
    if (is_commanded(rate)) return no_yaw();
    return StickStages<Fixed>::locked_yaw(yaw_sp, Fixed(0), heading, old_correction, correction);
  }

  static Fixed integrated_yaw(Fixed yaw_sp, Fixed rate, Fixed dt_us) {
    return wrap(yaw_sp + change(rate, dt_us));
  }

  // "None" would become a number.
  static Fixed turned(Fixed angle, Fixed turn) {
    return is_finite(angle) ? StickStages<Fixed>::turned(angle, turn) : angle;
  }
};

// The time between two setpoints is in microseconds, too.
struct Model : ReferenceModelStages<Fixed> {
  static Fixed elapsed(std::uint64_t elapsed_us) {
    return Fixed::of_raw(static_cast<Fixed::Wide>(elapsed_us));
  }

  static ModelDecay<Fixed> decay(Fixed elapsed_us, const Gains& gains) {
    const Fixed natural = gains.natural_rad_s;
    const Fixed k = change(natural, elapsed_us);
    const Fixed E = exp(-k);
    return {E + k * E, change(E, elapsed_us), natural * (k * E), E - k * E};
  }

  static Vector turn(const Vector& error, const Vector& rate, const Vector& command,
                     Fixed elapsed_us, const ModelDecay<Fixed>& left) {
    const Vector commanded(change(command[0], elapsed_us), change(command[1], elapsed_us),
                           change(command[2], elapsed_us));
    return (error - left.error_of_error * error) + left.error_of_rate * rate + commanded;
  }

  static Vector without_yaw(const Vector& rate, const Vector& z_R, Fixed yaw_rate) {
    if (!is_finite(yaw_rate) || !is_commanded(yaw_rate)) return rate;
    return rate - z_R * dot(rate, z_R);
  }
};

struct RateStep : RateStepStages<Fixed> {
  static Fixed step_time(std::uint64_t sample_us, std::uint64_t last_us) {
    return microseconds(sample_us - last_us, 125);
  }

  static RateUnitGains<Fixed> gains(const Parameters& parameters) {
    const auto from = rate_unit_gains<float>(parameters);
    RateUnitGains<Fixed> to;
    to.rate = {fixed(from.rate.proportional), fixed(from.rate.integral),
               fixed(from.rate.derivative), fixed(from.rate.feed_forward),
               fixed(from.rate.integral_max)};
    to.acro = {fixed(from.acro.rate_max_rad_s), fixed(from.acro.expo), fixed(from.acro.superexpo)};
    to.yaw_torque_tau_s = Fixed(from.yaw_torque_tau_s);
    to.battery_scaling = from.battery_scaling;
    return to;
  }
};

struct Rate : RateStages<Fixed> {
  static Fixed integrated(Fixed integral, Fixed factor, Fixed gain, Fixed error, Fixed dt_us) {
    return integral + change((factor * gain) * error, dt_us);
  }
};

struct AttitudePolicies {
  AttitudeStep step;
  Sticks sticks;
  AttitudeStages<Fixed> attitude;
  Model model;
};
struct RatePolicies {
  RateStep step;
  Rate rate;
};

const void* extension(const char* id) {
  if (std::strcmp(id, ATTEST_EXTENSION_UNSUPPORTED_GROUPS) == 0) return "robustness";
  const bool asked = std::strcmp(id, ATTEST_EXTENSION_ARITHMETIC) == 0;
  if (asked && Fixed::fraction_bits != 32) return "fixed:22";
  return cascade_extension<AttitudeUnit<Fixed, AttitudePolicies>, RateUnit<Fixed, RatePolicies>>(
      id);
}

}  // namespace

ATTEST_CASCADE_PORT("fixed point", extension)
