#include "harness/loop/disturbances.hpp"

#include <algorithm>
#include <variant>

#include "harness/core/ticks.hpp"

namespace attest {
namespace {

constexpr int changes_hz = 100;

bool is_zero(const Signal& signal) {
  const auto* constant = std::get_if<Constant>(&signal);
  return constant && constant->value == 0;
}

bool any_varies(const std::array<Signal, 3>& signals) {
  return std::any_of(signals.begin(), signals.end(), varies);
}

Vector3 at(const std::array<Sampler, 3>& samplers, Nanoseconds time) {
  return {samplers[0].at(time), samplers[1].at(time), samplers[2].at(time)};
}

}  // namespace

Disturbances::Disturbances(const Flight& flight, const Vehicle& vehicle, const Timeline& timeline)
    : wind_m_s_(samplers(flight.wind_m_s, timeline)),
      centre_of_mass_of_arm_(samplers(flight.centre_of_mass_of_arm, timeline)),
      arm_m_(vehicle.arm_m()),
      failure_(flight.motor_failure) {
  if (any_varies(flight.wind_m_s) || any_varies(flight.centre_of_mass_of_arm)) {
    TickSchedule schedule;
    schedule.rate = Rate::hz(changes_hz);
    times_ = ticks(schedule, schedule.rate.ticks_in(timeline.duration));
  } else {
    times_ = {Nanoseconds(0)};
  }
  if (!failure_) return;
  failure_at_ = failure_->at.on(timeline.rate);
  const auto place = std::lower_bound(times_.begin(), times_.end(), failure_at_);
  if (place == times_.end() || *place != failure_at_) times_.insert(place, failure_at_);
}

void Disturbances::apply(Nanoseconds now, Plant& plant) {
  if (wind_m_s_) plant.set_wind(at(*wind_m_s_, now));
  if (centre_of_mass_of_arm_) {
    Vector3 offset_m = at(*centre_of_mass_of_arm_, now);
    for (double& component : offset_m) component *= arm_m_;
    plant.set_centre_of_mass(offset_m);
  }
  if (failure_ && now >= failure_at_) failed_ = failure_->rotor;
}

std::optional<Disturbances::Samplers> Disturbances::samplers(const std::array<Signal, 3>& signals,
                                                             const Timeline& timeline) {
  if (std::all_of(signals.begin(), signals.end(), is_zero)) return std::nullopt;
  return Samplers{Sampler(signals[0], timeline), Sampler(signals[1], timeline),
                  Sampler(signals[2], timeline)};
}

}  // namespace attest
