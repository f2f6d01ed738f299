// Disturbances of the vehicle in flight: wind, a moving centre of mass, a motor failure.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "harness/casefile/flight.hpp"
#include "harness/plant/plant.hpp"

namespace attest {

class Disturbances {
 public:
  Disturbances(const Flight& flight, const Vehicle& vehicle, const Timeline& timeline);

  // The times to call apply(): t = 0, and the time of the motor failure. If a signal varies, also
  // 100 times a second, which is fast compared with the motion of the vehicles.
  const std::vector<Nanoseconds>& times() const { return times_; }

  // REQUIRES: `now` increases.
  void apply(Nanoseconds now, Plant& plant);

  // The rotor whose motor has failed; empty before the failure.
  const std::optional<std::size_t>& failed_rotor() const { return failed_; }

 private:
  using Samplers = std::array<Sampler, 3>;

  static std::optional<Samplers> samplers(const std::array<Signal, 3>& signals,
                                          const Timeline& timeline);

  std::optional<Samplers> wind_m_s_, centre_of_mass_of_arm_;  // empty: always 0
  double arm_m_;
  std::optional<MotorFailure> failure_;
  Nanoseconds failure_at_{0};
  std::vector<Nanoseconds> times_;
  std::optional<std::size_t> failed_;
};

}  // namespace attest
