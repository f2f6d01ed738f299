// Checks whose findings are printed one a line, for `attest doctor` and `attest smoke`.
#pragma once

#include <string>

#include "harness/host/port_process.hpp"

namespace attest::cli {

// Prints one line per check and stores whether any was bad.
class Examination {
 public:
  void good(const std::string& what, const std::string& finding) const;
  void bad(const std::string& what, const std::string& finding);
  void check(bool is_good, const std::string& what, const std::string& finding);
  bool all_good() const { return all_good_; }

 private:
  bool all_good_ = true;
};

// Starts the port, and checks the first steps of its units in each profile that it supports
// (host/smoke.hpp).
void examine_port(const HostOptions& options, Examination& examination);

}  // namespace attest::cli
