// The ticks of a unit of a log as candidates for single steps (single_steps.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "harness/ulog/flight_log.hpp"

namespace attest::ulog {

using Thrust = std::array<float, 3>;

bool same_bits(const Thrust& a, const Thrust& b);

// A step that can be judged if its setpoint was the one in use.
struct Candidate {
  Sample sample;                  // with the inputs of a single step
  bool has_own_setpoint = false;  // which the unit made from the sticks
  std::uint64_t setpoint_us = 0, age_us = 0;
  Thrust given{}, used{};  // the thrust of the setpoint, and the one that the step published

  bool has_same_thrust() const { return same_bits(given, used); }
};

// Why a step with an output is no candidate.
enum class Unfit : std::uint8_t { nothing_known, no_own_setpoint, reset, other_wings };
const char* text_of(Unfit why);

// Makes candidates of the ticks of a unit. REQUIRES: `log` outlives it.
class Candidates {
 public:
  explicit Candidates(const LoggedUnit& log) : log_(log), parameters_(log.trace.parameters) {}

  // The next tick. Empty if it has no output of the law, or it is unfit.
  std::optional<Candidate> next(const Sample& tick, const LoggedSetpoint& setpoint);

  // Of the ticks so far: those with an output, and how many of these are unfit.
  std::size_t outputs() const { return outputs_; }
  const std::map<Unfit, std::size_t>& unfit() const { return unfit_; }

 private:
  std::optional<Unfit> of_attitude_unit(const LoggedSetpoint& setpoint, Candidate& step);
  std::optional<Unfit> of_rate_unit(const LoggedSetpoint& setpoint, Candidate& step);
  void give_acro_setpoint(Candidate& step) const;
  Thrust scaled(Thrust thrust, attest_rate_inputs& in);
  void follow_parameters();

  const LoggedUnit& log_;
  const std::vector<ParameterChange>& parameters_;  // by ascending tick
  std::size_t next_ = 0, tick_ = 0;
  bool scales_ = false;
  float scale_ = 0;            // of the battery; 0: not known
  std::uint32_t updated_ = 0;  // the topics that the log had so far
  std::optional<std::uint8_t> last_counter_;
  std::uint64_t acro_us_ = 0;  // when the unit published its last setpoint in acro mode
  bool is_output_ = false;
  std::size_t outputs_ = 0;
  std::map<Unfit, std::size_t> unfit_;
};

}  // namespace attest::ulog
