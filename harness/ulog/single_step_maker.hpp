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

class SingleStepMaker {
 public:
  // `parameters`: the changes in the log, which outlive this.
  SingleStepMaker(Module module, const std::vector<ParameterChange>& parameters)
      : module_(module), parameters_(parameters) {}

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

// The single steps of a unit of a log, found tick by tick.
class SingleStepFinder {
 public:
  // As for SingleStepMaker.
  SingleStepFinder(Module module, const std::vector<ParameterChange>& parameters)
      : maker_(module, parameters), changes_(parameters) {}

  void next(const Sample& tick, const LoggedSetpoint& setpoint);

  // Of the ticks so far.
  const SingleStepMaker& maker() const { return maker_; }
  std::size_t with_own_setpoint() const { return with_own_setpoint_; }
  std::size_t with_given_setpoint() const { return steps_ - with_own_setpoint_; }
  // The changes of parameters up to the last single step. The tick of a change is the number of the
  // first single step after it.
  const std::vector<ParameterChange>& parameters() const { return parameters_; }
  // Few steps are kept, so that the log need not be read again.
  bool has_all() const { return in_memory_.size() == steps_; }
  const std::vector<SingleStep>& in_memory() const { return in_memory_; }

 private:
  SingleStepMaker maker_;
  const std::vector<ParameterChange>& changes_;  // in the log
  std::vector<ParameterChange> parameters_;
  std::size_t tick_ = 0;   // the next one
  std::size_t steps_ = 0;  // so far
  std::size_t with_own_setpoint_ = 0;
  std::vector<SingleStep> in_memory_;
};

}  // namespace attest::ulog
