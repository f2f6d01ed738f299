// Checks whether a port keeps the rules of the ABI, before the outputs of any case are compared.
#pragma once

#include <functional>
#include <string>

#include "harness/host/port_process.hpp"

namespace attest {

inline constexpr std::size_t smoke_steps = 100;

struct SmokeFinding {
  std::string check;  // "steps"
  std::string what;   // "100 of px4-v1.5.5"; if not good, also what is wrong
  bool is_good = true;
  bool is_remark = false;  // good, but the author of the port should read it
};

// Steps each unit of `profile` that the port has (not its mixer or battery estimate), with the
// inputs of a vehicle that shakes, at the port's fixed step or 250 Hz:
//
//     steps       every step returns ATTEST_OK, or the unit is unsupported
//     outputs     after the last step, the topics that carry the result are published, with numbers
//     repeatable  a second process of the port gives the same bits
//     parameters  a known name is accepted; the finding says whether an unknown name is, too
//     instances   a unit gives the same bits after another one was destroyed, and together with
//                 another one; for a program this also compares single steps with batches
//     NaN         inputs that are no numbers cause no fault
//
// Calls `report` for each finding. For a module, the checks end after a bad finding of the first
// three, or if it is unsupported. Returns whether all findings were good.
bool smoke(const HostOptions& options, const std::string& profile,
           const std::function<void(const SmokeFinding&)>& report);

}  // namespace attest
