// The law in fixed point: quaternions, matrices, angles, rates, controls and integrals. It cannot
// represent values that are not finite, and recovers no tailsitter; it declares both. Must pass at
// the numeric level. With 32 fraction bits it is judged like any port. With 22, which a 32-bit
// processor has room for, it declares its arithmetic and is judged as fixed point.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "controller/actuation/unit_table.hpp"
#include "controller/mc_att_control/mc_att_control_definition.hpp"
#include "controller/mc_att_control/unit_table.hpp"
#include "tests/ports/right/fixed.hpp"

namespace {

using namespace attest::mc_att_control;
using Vector = Vector3<Fixed>;

Vector fixed(const Vector3<float>& v) { return {Fixed(v[0]), Fixed(v[1]), Fixed(v[2])}; }

struct Step : StepStages<Fixed> {
  // Microseconds do not fit into Fixed; the clamped difference does.
  static Fixed step_time(std::uint64_t now_us, std::uint64_t last_us) {
    const auto us = static_cast<double>(std::clamp<std::uint64_t>(now_us - last_us, 2000, 20000));
    return Fixed(us / 1e6);
  }

  // Parameters are converted where they are set, by the ground station or the start-up code.
  static Gains<Fixed> gains(const Parameters& parameters) {
    const Gains<float> from = compute_gains<float>(parameters);
    Gains<Fixed> to;
    to.attitude = {fixed(from.attitude.proportional_1_s), fixed(from.attitude.rate_max_rad_s),
                   fixed(from.attitude.auto_rate_max_rad_s), Fixed(from.attitude.yaw_feed_forward),
                   Fixed(from.attitude.weathervane_scale)};
    to.rate = {fixed(from.rate.proportional), fixed(from.rate.integral),
               fixed(from.rate.derivative),   fixed(from.rate.feed_forward),
               Fixed(from.rate.tpa_break),    Fixed(from.rate.tpa_slope)};
    to.acro_rate_max_rad_s = fixed(from.acro_rate_max_rad_s);
    to.rattitude_threshold = Fixed(from.rattitude_threshold);
    to.battery_scaling = from.battery_scaling;
    to.actuators_cut = from.actuators_cut;
    return to;
  }

  static float battery_factor(const Topics& topics, const Gains<Fixed>& gains, Profile profile) {
    const bool scales =
        profile == Profile::px4_v1_5_5 && gains.battery_scaling && topics.battery_scale > 0.0f;
    return scales ? topics.battery_scale : 1.0f;
  }
};

struct NoRecovery {
  static RecoveryTilt<Fixed> tilt(const Quaternion<Fixed>&, const Quaternion<Fixed>&) {
    return {0, 0, Vector::Zero()};
  }
  static bool latch(bool, Fixed) { return false; }
  static Vector optimal_rates(const RecoveryTilt<Fixed>&) { return Vector::Zero(); }
  static Vector quaternion_rates(const Quaternion<Fixed>&, const Quaternion<Fixed>&,
                                 const AttitudeGains<Fixed>&) {
    return Vector::Zero();
  }
  static Fixed yaw_feed_forward(Fixed yaw, Fixed, const Quaternion<Fixed>&,
                                const AttitudeGains<Fixed>&) {
    return yaw;
  }
  static Vector limit(const Vector& rates, const AttitudeGains<Fixed>&) { return rates; }
};

struct Law {
  Step step;
  AttitudeStages<Fixed> attitude;
  RateStages<Fixed> rate;
  NoRecovery recovery;
};

// A sample that is not finite cannot be converted. It is left out, and the scale keeps its value.
int step_battery(void* self, const attest_battery_inputs* in, attest_battery_outputs* out) {
  const auto& [voltage_v, current_a, throttle, armed] = in->battery;
  const bool is_finite =
      std::isfinite(voltage_v) && std::isfinite(current_a) && std::isfinite(throttle);
  return is_finite ? attest::actuation::BatteryTable<Fixed>::table.step(self, in, out) : ATTEST_OK;
}

const attest_battery_status* battery_status() {
  static const attest_battery_status table = [] {
    attest_battery_status copy = attest::actuation::BatteryTable<Fixed>::table;
    copy.step = step_battery;
    return copy;
  }();
  return &table;
}

const void* extension(const char* id) {
  if (std::strcmp(id, ATTEST_EXTENSION_BATTERY_STATUS) == 0) return battery_status();
  if (std::strcmp(id, ATTEST_EXTENSION_UNSUPPORTED_GROUPS) == 0) return "tailsitter,robustness";
  if (const void* part = attest::actuation::extension<Fixed>(id)) return part;
  const bool asked = std::strcmp(id, ATTEST_EXTENSION_ARITHMETIC) == 0;
  return asked && Fixed::fraction_bits == 22 ? "fixed:22" : nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const attest_unit* attest_unit_v1(void) {
  static const attest_unit table = [] {
    attest_unit unit = UnitTable<McAttControl<Fixed, Law>>::named("fixed point", "1");
    unit.extension = extension;
    return unit;
  }();
  return &table;
}
