// The attitude unit with stages that record its distances from decisions.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/cascade/pure_laws.hpp"
#include "harness/golden/margin_meters.hpp"

namespace attest {
namespace {

using Q = cascade::Quaternion<double>;
using TraitsOfLaw = cascade::ProfileTraits;

// The angle [rad] between an axis and (0, 0, -1). At 0, the shortest rotation from (0, 0, 1) to the
// axis is arbitrary.
double from_opposite(const mc_att_control::Vector3<double>& axis) {
  return std::numbers::pi - std::atan2(std::hypot(axis[0], axis[1]), axis[2]);
}

// The distance [rad] of an angle from the nearer of pi and -pi: negative next to -pi.
double from_half_turn(double angle) {
  return std::copysign(std::numbers::pi - std::abs(angle), angle);
}

// Notes where a rotation is half a turn: its sign, and so the shorter way, is arbitrary there.
void note_half_turn(const Q& rotation, MarginNotes& notes) {
  notes.note(Decision::shorter_rotation, rotation[0] / rotation.norm());
}

// Notes whether a yaw rate is taken as 0. A rate of exactly 0 is the same in every port.
void note_yaw_rate(double rate, MarginNotes& notes) {
  if (rate == 0) return;
  notes.note(Decision::yaw_lock, std::abs(rate) / double(cascade::epsilon) - 1);
}

struct NotingAttitudeLaw : cascade::AttitudeStages<double> {
  using Law = cascade::AttitudeStages<double>;
  MarginNotes* notes;

  // If the thrust directions are opposite, the law does not use the tilt, so the axis of the tilt
  // does not matter.
  bool is_opposite(const Q& tilt) const {
    constexpr double almost_one = 0.999989986f;
    const bool opposite = Law::is_opposite(tilt);
    const double largest = std::max(std::abs(tilt[1]), std::abs(tilt[2]));
    notes->note(Decision::opposite_thrust, largest - almost_one);
    if (!opposite) notes->note(Decision::tilt_axis, 2 * std::abs(std::asin(tilt[0])));
    return opposite;
  }
  Q weighted_yaw(double w, double z, double weight) const {
    // With less weight than this, a whole turn of yaw is within tolerance.
    constexpr double some = 1e-6;
    if (weight > some) {
      notes->note(Decision::yaw_wrap, std::copysign(2 * std::abs(std::asin(w)), z));
    }
    return Law::weighted_yaw(w, z, weight);
  }
  Q error(const Q& q_WB, const Q& target) const {
    note_half_turn(cascade::product(cascade::inverse(q_WB), target), *notes);
    return Law::error(q_WB, target);
  }
};

struct NotingModel : cascade::ReferenceModelStages<double> {
  using Law = cascade::ReferenceModelStages<double>;
  MarginNotes* notes;

  Vector error(const Q& q_WR, const Q& q_WD) const {
    note_half_turn(cascade::product(cascade::inverse(q_WR), q_WD), *notes);
    return Law::error(q_WR, q_WD);
  }
  Vector without_yaw(const Vector& rate, const Vector& z_R, double yaw_rate) const {
    note_yaw_rate(yaw_rate, *notes);
    return Law::without_yaw(rate, z_R, yaw_rate);
  }
};

struct NotingSticks : cascade::StickStages<double> {
  using Law = cascade::StickStages<double>;
  MarginNotes* notes;

  double heading(const Q& q, const TraitsOfLaw& law) const {
    const double pitch = std::asin(2 * (q[0] * q[2] - q[1] * q[3]));
    constexpr double near_pole = 0.001f;
    const double from_pole = std::numbers::pi / 2 - std::abs(pitch);
    notes->note(Decision::heading_pole, from_pole - near_pole);
    return Law::heading(q, law);
  }
  bool is_lowest_throttle(double throttle, const Gains& gains) const {
    if (!gains.yaws_at_lowest_throttle) {
      notes->note(Decision::lowest_throttle, throttle - double(-0.9f));
    }
    return Law::is_lowest_throttle(throttle, gains);
  }
  bool correct_yaw(cascade::YawCorrection<double>& state, double heading, double unaided,
                   double dt_s, const TraitsOfLaw& law) const {
    const double error = cascade::wrap(heading - unaided);
    const double change = cascade::wrap(error - state.error.state);
    constexpr double converged_rad = 0.0174532924f;
    if (std::isfinite(unaided) && !state.lost) {
      notes->note(Decision::heading_wrap, from_half_turn(error));
      notes->note(Decision::convergence, std::abs(change) - converged_rad);
    }
    return Law::correct_yaw(state, heading, unaided, dt_s, law);
  }
  double locked_yaw(double yaw_sp, double rate, double heading, double old_correction,
                    double correction) const {
    note_yaw_rate(rate, *notes);
    return Law::locked_yaw(yaw_sp, rate, heading, old_correction, correction);
  }
  double turned(double angle, double turn) const {
    const double sum = Law::turned(angle, turn);
    notes->note(Decision::heading_wrap, from_half_turn(sum));
    return sum;
  }
  Q tilt_for_yaw_error(const Q& tilt, const Q& desired_yaw, const Q& q_WB) const {
    const mc_att_control::Vector3<double> up(0, 0, 1), z = cascade::z_axis(q_WB);
    const Q yaw = cascade::product(cascade::inverse(cascade::shortest_rotation(up, z)), q_WB);
    const Q to_desired = cascade::product(cascade::inverse(desired_yaw), yaw);
    notes->note(Decision::tilt_axis, from_opposite(z));
    notes->note(Decision::tilt_axis,
                from_opposite(cascade::z_axis(cascade::product(to_desired, tilt))));
    return Law::tilt_for_yaw_error(tilt, desired_yaw, q_WB);
  }
  // The quaternion of a yaw changes its sign where the yaw wraps at +-pi.
  Q desired_attitude(const Q& yaw, const Q& tilt) const {
    notes->note(Decision::heading_wrap, std::copysign(2 * std::abs(std::asin(yaw[0])), yaw[3]));
    return Law::desired_attitude(yaw, tilt);
  }
};

struct NotingAttitudeStep : cascade::AttitudeStepStages<double> {
  using Law = cascade::AttitudeStepStages<double>;
  MarginNotes* notes;

  cascade::AttitudeUnitGains<double> gains(const cascade::Parameters& parameters) const {
    const auto gains = Law::gains(parameters);
    const double weight = gains.attitude.yaw_weight;
    // A weight of exactly 0 is the same in every port.
    if (weight != 0) notes->note(Decision::yaw_weight, weight - double(1e-4f));
    return gains;
  }
  bool is_spooled(std::uint64_t now_us, const Status& status, double spoolup_us) const {
    const double armed_us = double(now_us - status.armed_time);
    // The time since arming is an integer [us], so every port compares it with a limit of exactly 0
    // in the same way.
    if (status.armed != 0 && spoolup_us != 0) {
      notes->note(Decision::spool_up, (armed_us - spoolup_us) * 1e-6);
    }
    return Law::is_spooled(now_us, status, spoolup_us);
  }
};

struct NotingAttitudeUnit {
  NotingAttitudeStep step;
  NotingSticks sticks;
  NotingAttitudeLaw attitude;
  NotingModel model;

  explicit NotingAttitudeUnit(MarginNotes* notes)
      : step{{}, notes}, sticks{{}, notes}, attitude{{}, notes}, model{{}, notes} {}
};

using AttitudeUnitMeter =
    UnitMeter<cascade::AttitudeUnit<double, NotingAttitudeUnit>, NotingAttitudeUnit,
              attest_attitude_inputs, attest_attitude_outputs>;
using AttitudeLawMeter =
    UnitMeter<cascade::PureAttitudeLaw<double, NotingAttitudeUnit>, NotingAttitudeUnit,
              attest_attitude_law_inputs, attest_attitude_law_outputs>;

}  // namespace

std::unique_ptr<MarginMeter> attitude_unit_meter(const std::string& profile) {
  return meter_of<AttitudeUnitMeter>(cascade::profile_from_name(profile), Module::attitude_unit);
}

std::unique_ptr<MarginMeter> attitude_law_meter(const std::string& profile) {
  return meter_of<AttitudeLawMeter>(cascade::profile_from_name(profile), Module::attitude_law);
}

}  // namespace attest
