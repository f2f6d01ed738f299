#include "harness/golden/margins.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "controller/actuation/unit_table.hpp"
#include "controller/reference/mc_att_control_definition.hpp"

namespace attest {
namespace {

using reference::AttitudeGains;
using reference::Matrix3;
using reference::Quaternion;
using reference::Topics;
using Vector3d = reference::Vector3<double>;
using Matrix3d = Matrix3<double>;
using Tilt = reference::TiltError<double>;

// The margins that the stages have noted so far.
struct Notes {
  Margins margins;
  std::size_t tick = 0;

  // A NaN distance never counts.
  void note(Decision decision, double distance) {
    Margin& least = margins.of[static_cast<std::size_t>(decision)];
    if (distance < least.distance) least = {distance, tick};
  }
};

struct Step : reference::StepStages<double> {
  Notes* notes;

  bool sticks_beyond(const decltype(Topics::manual)& manual, double threshold) const {
    const double x = std::abs(double(manual.x)), y = std::abs(double(manual.y));
    // One stick beyond the threshold is enough, so the larger decides.
    notes->note(Decision::rattitude, std::abs(std::max(x, y) - threshold));
    return reference::StepStages<double>::sticks_beyond(manual, threshold);
  }
  float battery_factor(const Topics& topics, const reference::Gains<double>& gains,
                       reference::Profile profile) const {
    const double scale = std::abs(double(topics.battery_scale));
    // A scale of exactly 0 means no scaling in every port.
    if (gains.battery_scaling && scale != 0) notes->note(Decision::battery_scale, scale);
    return reference::StepStages<double>::battery_factor(topics, gains, profile);
  }
};

struct Attitude : reference::AttitudeStages<double> {
  using Law = reference::AttitudeStages<double>;
  Notes* notes;

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
      notes->note(Decision::yaw_wrap, std::numbers::pi - std::abs(error / weight));
    }
    return error;
  }
  Vector3d direct_error(const Matrix3d& R_WB, const Matrix3d& R_WD) const {
    const auto q = reference::quaternion_of(reference::ordered::transpose_product(R_WB, R_WD));
    notes->note(Decision::shorter_rotation, std::abs(q.w()));
    return Law::direct_error(R_WB, R_WD);
  }
};

// The distance of `value` from the ends of (-bound, bound): negative when it is outside.
double inside(double value, double bound) { return bound - std::abs(value); }

struct RateMargins : reference::RateStages<double> {
  using Law = reference::RateStages<double>;
  Notes* notes;

  bool may_integrate(double thrust_sp, const reference::MotorLimits& limits) const {
    if (!limits.lower && !limits.upper) {
      notes->note(Decision::thrust_gate, std::abs(thrust_sp - double(reference::takeoff_thrust)));
    }
    return Law::may_integrate(thrust_sp, limits);
  }
  double integrate_axis(double integral, double control, double thrust_sp, double growth,
                        bool frozen) const {
    // A step of the integral below this is far within its tolerance, so its gates do not matter.
    constexpr double negligible = 2e-6;
    if (!frozen && std::abs(growth) > negligible) {
      const double bound = double(reference::integral_limit);
      const std::array gates = {inside(control, thrust_sp), inside(integral + growth, bound),
                                inside(control, bound)};
      // If all gates are open, the nearest to closing decides. Otherwise all closed gates have to
      // open, and the farthest from opening decides.
      const double least = *std::min_element(gates.begin(), gates.end());
      notes->note(Decision::integrator_gate, std::abs(least));
    }
    return Law::integrate_axis(integral, control, thrust_sp, growth, frozen);
  }
};

struct Recovery : reference::RecoveryStages<double> {
  using Law = reference::RecoveryStages<double>;
  Notes* notes;

  bool latch(bool recovering, double tilt_rad) const {
    const double threshold = reference::radians(recovering ? 5.0 : 30.0);
    notes->note(Decision::recovery_latch, std::abs(tilt_rad - threshold));
    return Law::latch(recovering, tilt_rad);
  }
  Vector3d quaternion_rates(const Quaternion<double>& q_WB, const Quaternion<double>& q_WD,
                            const AttitudeGains<double>& gains) const {
    const Quaternion<double> q = reference::product(reference::conjugate(q_WD), q_WB);
    notes->note(Decision::recovery_rotation, std::abs(q.w()));
    return Law::quaternion_rates(q_WB, q_WD, gains);
  }
};

struct NotingLaw {
  Step step;
  Attitude attitude;
  RateMargins rate;
  Recovery recovery;

  explicit NotingLaw(Notes* notes)
      : step{{}, notes}, attitude{{}, notes}, rate{{}, notes}, recovery{{}, notes} {}
};

struct Mixing : actuation::MixerStages<double> {
  using Law = actuation::MixerStages<double>;
  Notes* notes;

  explicit Mixing(Notes* to) : notes(to) {}

  Fit fit(double min_out, double max_out, double thrust) const {
    notes->note(Decision::mixer_limit, std::min(std::abs(min_out), std::abs(max_out - 1)));
    const bool one_end = (min_out < 0) != (max_out > 1);
    if (one_end) notes->note(Decision::mixer_branch, std::abs(min_out + max_out - 1));
    return Law::fit(min_out, max_out, thrust);
  }
  // The rotor that is furthest out sets the flag, in any order of the rotors.
  bool yield_yaw(std::span<const actuation::Rotor> rotors, Controls& c, const Fit& fit) const {
    double beyond = -std::numeric_limits<double>::infinity();
    for (const actuation::Rotor& rotor : rotors) {
      const double out =
          without_yaw(rotor, c, fit.roll_pitch_scale) + c.yaw * rotor.yaw + c.thrust + fit.boost;
      beyond = std::max({beyond, -out, out - 1});
    }
    notes->note(Decision::mixer_yaw, std::abs(beyond));
    return Law::yield_yaw(rotors, c, fit);
  }
};

Margins mixer_margins(const Trace& given, const std::string& definition) {
  Notes notes;
  const auto parsed = actuation::parse_mixer(definition);
  if (!parsed) return {};
  actuation::BasicMixer<double, Mixing> mixer(*parsed, Mixing(&notes));
  attest_mixer_outputs out{};
  for (notes.tick = 0; notes.tick < given.samples.size(); ++notes.tick) {
    actuation::step_mixer(mixer, given.samples[notes.tick].mixer_in, out);
  }
  return notes.margins;
}

void note_norm(const float (&q)[4], Notes& notes) {
  double squared = 0;
  for (const float component : q) squared += double(component) * double(component);
  // All ports treat zeros and non-finite values the same way.
  if (squared == 0 || !std::isfinite(squared)) return;
  Margin& worst = notes.margins.of[static_cast<std::size_t>(Decision::quaternion_norm)];
  const Margin off{std::abs(std::sqrt(squared) - 1), notes.tick};
  if (is_nearer(Decision::quaternion_norm, off, worst)) worst = off;
}

struct DecisionTraits {
  Decision decision;
  std::string_view name;
  double least_margin;
};

constexpr double of_input = 1e-6;  // an input differs by a port's number format only
constexpr double of_law = 1e-5;

// In the order of the enumerators.
constexpr std::array<DecisionTraits, decision_count> all_traits{{
    {Decision::quaternion_norm, "norm of quaternions", 1e-6},  // of float32, within 1e-7 of 1
    {Decision::thrust_gate, "thrust gate", of_input},
    {Decision::integrator_gate, "integrator gate", of_law},
    {Decision::rattitude, "rattitude", of_input},
    {Decision::shorter_rotation, "shorter rotation", of_law},
    {Decision::yaw_wrap, "yaw at +-180 deg", of_law},
    {Decision::tilt_axis, "tilt at 180 deg", 1e-3},  // where the tolerance stops widening
    {Decision::battery_scale, "battery scale", of_input},
    {Decision::recovery_latch, "recovery's latch", of_law},
    {Decision::recovery_rotation, "recovery's rotation", of_law},
    {Decision::mixer_limit, "mixer limit", of_law},
    {Decision::mixer_branch, "mixer branch", of_law},
    {Decision::mixer_yaw, "mixer yaw", of_law},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < all_traits.size(); ++i) {
    if (all_traits[i].decision != static_cast<Decision>(i)) return false;
  }
  return true;
}
static_assert(is_in_order());

const DecisionTraits& traits_of(Decision decision) {
  return all_traits[static_cast<std::size_t>(decision)];
}

}  // namespace

std::string_view name_of(Decision decision) { return traits_of(decision).name; }

double least_margin(Decision decision) { return traits_of(decision).least_margin; }

bool is_nearer(Decision decision, const Margin& one, const Margin& other) {
  if (std::isinf(one.distance) || std::isinf(other.distance)) return !std::isinf(one.distance);
  const bool larger_is_nearer = decision == Decision::quaternion_norm;
  return larger_is_nearer ? one.distance > other.distance : one.distance < other.distance;
}

bool Margins::is_safe(Decision decision) const {
  return !is_nearer(decision, (*this)[decision], {least_margin(decision)});
}

double least_margin(Decision decision, std::optional<int> fraction_bits) {
  const double of_floats = least_margin(decision);
  return fraction_bits ? std::max(of_floats, std::ldexp(decision_lsb, -*fraction_bits)) : of_floats;
}

struct MarginMeter::Impl {
  explicit Impl(reference::Profile profile) : control(profile, NotingLaw(&notes)) {}

  Notes notes;
  reference::McAttControl<double, NotingLaw> control;
  attest_outputs out{};
};

MarginMeter::MarginMeter(std::string_view profile)
    : impl_(std::make_unique<Impl>(*reference::profile_from_name(profile))) {}
MarginMeter::~MarginMeter() = default;

const Margins& MarginMeter::step(std::span<const ParameterChange> changes,
                                 const attest_inputs& in) {
  Notes& notes = impl_->notes;
  notes.margins = {};
  for (const ParameterChange& change : changes) {
    impl_->control.set_parameter(change.name, change.value);
  }
  note_norm(in.control_state.q, notes);
  if (in.updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) {
    note_norm(in.vehicle_attitude_setpoint.q_d, notes);
  }
  impl_->control.step(in, impl_->out);
  ++notes.tick;
  return notes.margins;
}

namespace {

void keep_nearest(const Margins& at_tick, Margins& all) {
  for (std::size_t i = 0; i < decision_count; ++i) {
    if (is_nearer(static_cast<Decision>(i), at_tick.of[i], all.of[i])) all.of[i] = at_tick.of[i];
  }
}

Margins controller_margins(const Trace& given, const std::string& profile) {
  if (!reference::profile_from_name(profile)) return {};
  MarginMeter meter(profile);
  PendingChanges changes(given.parameters);
  Margins all;
  for (std::size_t tick = 0; tick < given.samples.size(); ++tick) {
    keep_nearest(meter.step(changes.take_until(tick), given.samples[tick].in), all);
  }
  return all;
}

}  // namespace

Margins margins(const Trace& given, const Subject& subject) {
  switch (subject.module) {
    case Module::mixer:
      return mixer_margins(given, subject.mixer);
    case Module::battery_status:
    case Module::attitude_unit:
    case Module::rate_unit:
      return {};
    case Module::mc_att_control:
      return controller_margins(given, subject.profile);
  }
  return {};
}

}  // namespace attest
