// Checks whose findings are printed one a line, for `attest doctor` and `attest smoke`.
#pragma once

#include <string>

#include "harness/cli/globals.hpp"
#include "harness/host/port_process.hpp"

namespace attest::cli {

// Prints one line per check, and stores the exit code: exit_ok, or the largest of the bad checks.
class Examination {
 public:
  void good(const std::string& what, const std::string& finding) const;
  // `code`: exit_failed if the port broke a rule, exit_usage if the machine, the suite or the start
  // of the port is wrong.
  void bad(const std::string& what, const std::string& finding, Exit code = exit_usage);
  void check(bool is_good, const std::string& what, const std::string& finding,
             Exit code = exit_usage);
  Exit code() const { return code_; }

 private:
  Exit code_ = exit_ok;
};

// Starts the port, and checks the first steps of its units in each profile that it supports
// (host/smoke.hpp).
void examine_port(const HostOptions& options, Examination& examination);

}  // namespace attest::cli
