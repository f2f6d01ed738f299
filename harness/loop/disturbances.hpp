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

  // When they change: at t = 0 only, or 100 times a second for signals that vary, which is fast
  // compared with any vehicle here. In addition, when the motor fails.
  const std::vector<Nanoseconds>& times() const { return times_; }

  // REQUIRES: times increase.
  void apply(Nanoseconds now, Plant& plant);

  // Empty before it fails.
  const std::optional<std::size_t>& failed_rotor() const { return failed_; }

 private:
  using Samplers = std::array<Sampler, 3>;

  static std::optional<Samplers> samplers(const std::array<Signal, 3>& signals,
                                          const Timeline& timeline);

  std::optional<Samplers> wind_m_s_, centre_of_mass_of_arm_;  // empty: zero throughout
  double arm_m_;
  std::optional<MotorFailure> failure_;
  Nanoseconds failure_at_{0};
  std::vector<Nanoseconds> times_;
  std::optional<std::size_t> failed_;
};

}  // namespace attest
