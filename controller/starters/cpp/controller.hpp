/* SPDX-License-Identifier: BSD-3-Clause */
// controller.hpp - one controller: latches inputs, selects the mode, publishes outputs.
#ifndef ATTEST_STARTER_CPP_CONTROLLER_HPP
#define ATTEST_STARTER_CPP_CONTROLLER_HPP

#include <cstdint>
#include <optional>
#include <string_view>

#include <attest_unit.h>

#include "attitude.hpp"
#include "parameters.hpp"
#include "rate.hpp"
#include "tailsitter.hpp"
#include "vector.hpp"

namespace starter {

class Controller {
 public:
  explicit Controller(Profile profile) noexcept;

  bool set_parameter(std::string_view name, float value) noexcept {
    return parameters_.set(profile_, name, value);
  }

  // Writes `published` of all topics, and the other fields of the topics that it publishes.
  void step(const attest_inputs& in, attest_outputs& out) noexcept;

 private:
  enum class Topics { virtual_of_vtol, of_multicopter };

  bool take(std::uint32_t updated_bit) noexcept;
  template <typename Sample>
  void latch(std::uint32_t updated_bit, Sample attest_inputs::*topic,
             const attest_inputs& in) noexcept;
  void latch_inputs(const attest_inputs& in) noexcept;

  void outer_loop(const attest_inputs& in, attest_outputs& out) noexcept;
  void attitude_mode() noexcept;
  void acro_mode() noexcept;
  void offboard_rates_mode() noexcept;
  Vec3 inner_loop(float dt) noexcept;

  void publish_rates_setpoint(attest_outputs& out) noexcept;
  void publish_controls(const Vec3& control, attest_outputs& out) const noexcept;
  void publish_status(attest_outputs& out) const noexcept;

  Profile profile_;
  Parameters parameters_;
  std::optional<Gains> gains_;  // empty before the first step

  attest_inputs copy_{};          // each topic as it was last latched
  std::uint32_t pending_ = 0;     // ATTEST_UPDATED_ bits of samples not latched yet
  std::optional<Topics> topics_;  // to publish on; empty before the first vehicle_status

  std::optional<TailsitterLoop> tailsitter_;  // replaces attitude_law(); decided at the first step
  RateLoop rate_loop_;
  Vec3 rates_sp_;  // [rad/s]
  float thrust_sp_ = 0.0f;
};

}  // namespace starter

#endif  // ATTEST_STARTER_CPP_CONTROLLER_HPP
