// Makes single steps (single_steps.hpp) of the ticks of a unit of a log.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "harness/ulog/flight_log.hpp"

namespace attest::ulog {

// The inputs of a tick that is judged alone, and its logged outputs.
struct SingleStep {
  Sample sample;
  LoggedSetpoint setpoint;
};

// Why a tick with outputs of the law is no single step.
enum class Unfit : std::uint8_t {
  nothing_known,
  no_own_setpoint,
  other_thrust,
  reset,
  other_wings
};
const char* text_of(Unfit why);

// REQUIRES: `log` outlives it.
class SingleStepMaker {
 public:
  explicit SingleStepMaker(const LoggedUnit& log)
      : module_(log.module), parameters_(log.trace.parameters) {}

  // Takes the next tick. Empty if it has no outputs of the law, or is unfit.
  std::optional<SingleStep> next(const Sample& tick, const LoggedSetpoint& setpoint);

  // Of the ticks so far: those with outputs, and how many of these are unfit.
  std::size_t outputs() const { return outputs_; }
  const std::map<Unfit, std::size_t>& unfit() const { return unfit_; }

 private:
  std::optional<Unfit> make_of_attitude_unit(bool is_reset, SingleStep& step) const;
  std::optional<Unfit> make_of_rate_unit(SingleStep& step) const;
  void follow_parameters();

  Module module_;
  const std::vector<ParameterChange>& parameters_;  // by ascending tick
  std::size_t next_ = 0, tick_ = 0;
  bool scales_ = false;        // torque and thrust, by the battery
  float scale_ = 0;            // of the battery, the last valid one; 0: not known
  std::uint32_t updated_ = 0;  // the topics that the log had so far
  std::optional<std::uint8_t> last_counter_;
  std::uint64_t acro_us_ = 0;  // when the unit published its last setpoint in acro mode
  std::size_t outputs_ = 0;
  std::map<Unfit, std::size_t> unfit_;
};

}  // namespace attest::ulog
