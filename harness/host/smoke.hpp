// Whether a port keeps the rules of the ABI, before any law is compared.
#pragma once

#include <functional>
#include <string>

#include "harness/host/port_process.hpp"

namespace attest {

inline constexpr std::size_t smoke_steps = 100;

struct SmokeFinding {
  std::string check;  // "steps"
  std::string what;   // "100 of px4-v1.5.5"; if it is bad, followed by what is wrong
  bool is_good = true;
};

// Lets fresh units of `profile`, of each of its modules that the port has, control a vehicle that
// shakes, at the port's fixed step or 250 Hz:
//
//     steps       every step returns ATTEST_OK
//     outputs     the topics that carry the result are published, and have numbers
//     repeatable  a second process of the port gives the same bits
//     parameters  a known name is accepted; says if an unknown name is, too
//     instances   a unit gives the same bits after another one, and together with one; of a
//                 program, also step by step as in batches
//     NaN         inputs that are no numbers end no step
//
// Reports the findings one after the other. Ends after the first bad one of the first three.
// Returns whether all were good.
bool smoke(const HostOptions& options, const std::string& profile,
           const std::function<void(const SmokeFinding&)>& report);

}  // namespace attest
