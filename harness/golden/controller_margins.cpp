// The controller of v1.5.5 and v1.3.4 with stages that record its distances from decisions.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "controller/mc_att_control/mc_att_control_definition.hpp"
#include "controller/mc_att_control/pure_laws.hpp"
#include "harness/golden/margin_meters.hpp"

namespace attest {
namespace {

using mc_att_control::AttitudeGains;
using mc_att_control::Matrix3;
using mc_att_control::Quaternion;
using mc_att_control::Topics;
using Vector3d = mc_att_control::Vector3<double>;
using Matrix3d = Matrix3<double>;
using Tilt = mc_att_control::TiltError<double>;

struct NotingStep : mc_att_control::StepStages<double> {
  MarginNotes* notes;

  bool sticks_beyond(const decltype(Topics::manual)& manual, double threshold) const {
    const double x = std::abs(double(manual.x)), y = std::abs(double(manual.y));
    // One stick beyond the threshold is enough, so the larger decides.
    notes->note(Decision::rattitude, std::max(x, y) - threshold);
    return mc_att_control::StepStages<double>::sticks_beyond(manual, threshold);
  }
  float battery_factor(const Topics& topics, const mc_att_control::Gains<double>& gains,
                       mc_att_control::Profile profile) const {
    const auto scale = double(topics.battery_scale);
    // Every port takes a scale of exactly 0 as no scaling.
    if (gains.battery_scaling && scale != 0) notes->note(Decision::battery_scale, scale);
    return mc_att_control::StepStages<double>::battery_factor(topics, gains, profile);
  }
};

struct NotingAttitude : mc_att_control::AttitudeStages<double> {
  using Law = mc_att_control::AttitudeStages<double>;
  MarginNotes* notes;

  Tilt tilt_error(const Matrix3d& R_WB, const Matrix3d& R_WD) const {
    const Tilt tilt = Law::tilt_error(R_WB, R_WD);
    if (tilt.sine > 0) {
      notes->note(Decision::tilt_axis, std::numbers::pi - std::atan2(tilt.sine, tilt.cosine));
    } else if (tilt.cosine < 0) {
      notes->note(Decision::tilt_axis, 0);
    }
    return tilt;
  }
  double yaw_error(const Vector3d& nose, const Matrix3d& R_WD, double weight) const {
    const double error = Law::yaw_error(nose, R_WD, weight);
    // With less weight than this, a whole turn of yaw is within tolerance.
    constexpr double some = 1e-6;
    if (weight > some) {
      const double angle = error / weight;
      notes->note(Decision::yaw_wrap, std::copysign(std::numbers::pi - std::abs(angle), angle));
    }
    return error;
  }
  Vector3d direct_error(const Matrix3d& R_WB, const Matrix3d& R_WD) const {
    const auto q =
        mc_att_control::quaternion_of(mc_att_control::ordered::transpose_product(R_WB, R_WD));
    notes->note(Decision::shorter_rotation, q.w());
    return Law::direct_error(R_WB, R_WD);
  }
};

// The distance of `value` from the nearer end of (-bound, bound): negative if `value` is outside.
double inside(double value, double bound) { return bound - std::abs(value); }

struct NotingRate : mc_att_control::RateStages<double> {
  using Law = mc_att_control::RateStages<double>;
  MarginNotes* notes;

  bool may_integrate(double thrust_sp, const mc_att_control::MotorLimits& limits) const {
    if (!limits.lower && !limits.upper) {
      notes->note(Decision::thrust_gate, thrust_sp - double(mc_att_control::takeoff_thrust));
    }
    return Law::may_integrate(thrust_sp, limits);
  }
  double integrate_axis(double integral, double control, double thrust_sp, double growth,
                        bool frozen) const {
    // A step of the integral below this is far within the integral's tolerance, so the gates do not
    // matter.
    constexpr double negligible = 2e-6;
    if (!frozen && std::abs(growth) > negligible) {
      const double bound = double(mc_att_control::integral_limit);
      const std::array gates = {inside(control, thrust_sp), inside(integral + growth, bound),
                                inside(control, bound)};
      // If all gates are open, the nearest to closing decides. Otherwise all closed gates have to
      // open, and the farthest from opening decides.
      const double least = *std::min_element(gates.begin(), gates.end());
      notes->note(Decision::integrator_gate, least);
    }
    return Law::integrate_axis(integral, control, thrust_sp, growth, frozen);
  }
};

struct NotingRecovery : mc_att_control::RecoveryStages<double> {
  using Law = mc_att_control::RecoveryStages<double>;
  MarginNotes* notes;

  bool latch(bool recovering, double tilt_rad) const {
    // A NaN in a quaternion gives ports a tilt of NaN, 0 or pi: the law does not say which.
    const double from_limit = tilt_rad - mc_att_control::radians(recovering ? 5.0 : 30.0);
    notes->note(recovering ? Decision::recovery_end : Decision::recovery_begin,
                std::isnan(tilt_rad) ? 0 : from_limit);
    return Law::latch(recovering, tilt_rad);
  }
  Vector3d optimal_rates(const mc_att_control::RecoveryTilt<double>& tilt) const {
    // At exactly half a turn the law takes a fixed axis.
    if (const double from_half_turn = std::numbers::pi - tilt.angle_rad; from_half_turn > 0) {
      notes->note(Decision::tilt_axis, from_half_turn);
      // The direction is folded to 0 to pi/2. The sign of roll tells on which side it was.
      notes->note(Decision::recovery_side, std::copysign(tilt.direction_rad, tilt.signs[0]));
    }
    return Law::optimal_rates(tilt);
  }
  Vector3d quaternion_rates(const Quaternion<double>& q_WB, const Quaternion<double>& q_WD,
                            const AttitudeGains<double>& gains) const {
    const Quaternion<double> q = mc_att_control::product(mc_att_control::conjugate(q_WD), q_WB);
    notes->note(Decision::recovery_rotation, q.w());
    return Law::quaternion_rates(q_WB, q_WD, gains);
  }
};

struct NotingController {
  NotingStep step;
  NotingAttitude attitude;
  NotingRate rate;
  NotingRecovery recovery;

  explicit NotingController(MarginNotes* notes)
      : step{{}, notes}, attitude{{}, notes}, rate{{}, notes}, recovery{{}, notes} {}
};

void note_norm(const float (&q)[4], MarginNotes& notes) {
  double squared = 0;
  for (const float component : q) squared += double(component) * double(component);
  // All ports treat zeros and non-finite values the same way.
  if (squared == 0 || !std::isfinite(squared)) return;
  notes.note(Decision::quaternion_norm, std::sqrt(squared) - 1);
}

using LawMeter = UnitMeter<mc_att_control::McAttControl<double, NotingController>, NotingController,
                           attest_inputs, attest_outputs>;

class ControllerMeter final : public LawMeter {
 public:
  using LawMeter::LawMeter;

 private:
  void measure(std::span<const ParameterChange> changes, const Sample& sample) override {
    const attest_inputs& in = sample.in;
    note_norm(in.control_state.q, notes_);
    if ((in.updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) != 0) {
      note_norm(in.vehicle_attitude_setpoint.q_d, notes_);
    }
    LawMeter::measure(changes, sample);
  }
};

using PureAttitudeMeter =
    UnitMeter<mc_att_control::PureAttitudeLaw<double, NotingController>, NotingController,
              attest_attitude_law_inputs, attest_attitude_law_outputs>;
using OldRateLawMeter =
    UnitMeter<mc_att_control::PureRateLaw<double, NotingController>, NotingController,
              attest_rate_law_inputs, attest_rate_law_outputs>;

class OldAttitudeLawMeter final : public PureAttitudeMeter {
 public:
  using PureAttitudeMeter::PureAttitudeMeter;

 private:
  void measure(std::span<const ParameterChange> changes, const Sample& sample) override {
    note_norm(sample.attitude_law.in.vehicle_attitude.q, notes_);
    note_norm(sample.attitude_law.in.vehicle_attitude_setpoint.q_d, notes_);
    PureAttitudeMeter::measure(changes, sample);
  }
};

}  // namespace

std::unique_ptr<MarginMeter> controller_meter(const std::string& profile) {
  return meter_of<ControllerMeter>(mc_att_control::profile_from_name(profile),
                                   Module::mc_att_control);
}

std::unique_ptr<MarginMeter> old_attitude_law_meter(const std::string& profile) {
  return meter_of<OldAttitudeLawMeter>(mc_att_control::profile_from_name(profile),
                                       Module::attitude_law);
}

std::unique_ptr<MarginMeter> old_rate_law_meter(const std::string& profile) {
  return meter_of<OldRateLawMeter>(mc_att_control::profile_from_name(profile), Module::rate_law);
}

}  // namespace attest
