// The wrong controllers themselves: a law with mistakes of the catalogue in it, and its unit.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "controller/attest_unit.h"
#include "controller/faults/fault.hpp"
#include "controller/faults/faulty_law.hpp"

namespace attest::faults {

// The law with these mistakes in it, together.
FaultyLaw law_with(std::span<const Fault* const> faults);

// A controller of profile `px4-v1.5.5` or `px4-v1.3.4` with some mistakes.
class FaultyController {
 public:
  FaultyController(Profile profile, std::span<const Fault* const> faults);
  ~FaultyController();

  // As of McAttControl.
  bool set_parameter(std::string_view name, float value);
  void step(const attest_inputs& in, attest_outputs& out);

 private:
  FaultyLaw law_;
  struct Controller;
  std::unique_ptr<Controller> controller_;
};

}  // namespace attest::faults
