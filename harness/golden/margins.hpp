// The margins of a vector: its distances from the decisions of the law (decisions.hpp).
//
// The distances are measured in double, on the law itself. Its stages are template parameters, and
// a meter replaces them by stages that record the distances.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "harness/golden/decisions.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Where the stages of a meter record their distances.
struct MarginNotes {
  Margins margins;  // of tick `tick` alone
  std::size_t tick = 0;

  // `from_threshold`: the value minus its threshold.
  void note(Decision decision, double from_threshold) {
    margins.note(decision, from_threshold, tick);
  }
};

// Measures the margins of a module tick by tick, from its power-on state on.
class MarginMeter {
 public:
  virtual ~MarginMeter() = default;

  // The margins of the next tick alone; valid until the next call.
  const Margins& step(std::span<const ParameterChange> changes, const Sample& sample);

 protected:
  MarginNotes notes_;

 private:
  // A step of the law, which records its distances in `notes_`.
  virtual void measure(std::span<const ParameterChange> changes, const Sample& sample) = 0;
};

// Null if the module has no decisions (a battery estimate is continuous), if the reference does not
// have the profile, or if the definition of the mixer is wrong.
std::unique_ptr<MarginMeter> margin_meter(const ModuleUnderTest& subject);

// The nearest margins of all ticks of `given`. REQUIRES: `meter` has made no step yet.
Margins margins(const Trace& given, MarginMeter& meter);

}  // namespace attest
