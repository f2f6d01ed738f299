// The inputs of two traces. Outputs can tell two laws apart only where the inputs are the same.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "harness/trace/trace.hpp"

namespace attest {

// The first input or parameter in force that differs by bits. Every NaN equals every NaN.
struct InputDifference {
  std::size_t tick = 0;
  // "in/parameter.MC_ROLL_P"; "the profile", at tick 0; empty: one trace has ended before this
  // tick.
  std::string column;
  std::string one, other;  // the values; "not set" for a parameter

  friend bool operator==(const InputDifference&, const InputDifference&) = default;
};

// "in/parameter.MC_ROLL_P is 6.5 in a.csv and 7 in b.csv"
std::string text_of(const InputDifference& found, const std::string& one, const std::string& other);

// Compares the inputs of two traces, of which the caller adds part by part.
class InputComparer {
 public:
  // The inputs and parameters that are compared: those that both traces have, for files, which need
  // not record all of them; or all of the module, where an absent input is 0.
  enum class Compared { in_both, all };

  // `one` and `other`: the recorded channels.
  InputComparer(const ChannelSet& one, const ChannelSet& other, Compared compared);

  // The next ticks of both: parts of equal length, but for the last ones.
  void add(const Trace& one, const Trace& other);

  const std::optional<InputDifference>& first() const { return first_; }

 private:
  using Parameters = std::map<std::string, float>;

  void compare_parameters();
  void compare_inputs(const Sample& one, const Sample& other);

  Compared compared_;
  ChannelSet inputs_;
  std::size_t tick_ = 0;          // the next one to add
  Parameters of_one_, of_other_;  // in force
  std::optional<InputDifference> first_;
};

// Of two whole traces, of all inputs. A parameter that only one of them sets differs.
std::optional<InputDifference> first_input_difference(const Trace& one, const Trace& other);

}  // namespace attest
