// Checks whose findings are printed one a line, with a conclusion at the end, for `attest doctor`
// and `attest smoke`.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "harness/cli/command.hpp"
#include "harness/host/port_process.hpp"

namespace attest::cli {

class Examination {
 public:
  // `verbose`: every finding is printed. Otherwise good details are only counted. With
  // Globals::quiet only failures are printed.
  Examination(const Globals& globals, bool verbose) : quiet_(globals.quiet), verbose_(verbose) {}

  // The checks that follow are of `part`: "the suite". The conclusion says which parts work.
  void begin(const std::string& part) { parts_.push_back({part}); }

  void good(const std::string& what, const std::string& finding);
  void good_detail(const std::string& what, const std::string& finding);
  // One line in place of the good details, which `verbose` prints. No check of its own.
  void summary(const std::string& what, const std::string& finding) const;
  // Good, but the author of the port should read it. Equal findings are printed once.
  void remark(const std::string& what, const std::string& finding);
  // The part works, but lacks `lack`: the conclusion says so.
  void partly_good(const std::string& what, const std::string& finding, const std::string& lack);
  // `code`: exit_failed if the port broke a rule, exit_usage if the machine, the suite or the start
  // of the port is wrong. Without `verbose`, the first four bad findings of a part are printed.
  void bad(const std::string& what, const std::string& finding, Exit code = exit_usage);

  std::size_t bad_checks() const;  // of the part

  // Prints the conclusion: "PASS the machine and the suite work: 12 checks". Returns exit_ok, or
  // the largest code of the bad findings.
  Exit conclude() const;

 private:
  struct Part {
    std::string name;
    std::size_t checks = 0, bad = 0;
    std::string first_bad = {};
  };

  void print(const std::string& what, const std::string& finding) const;
  std::string sentence() const;

  bool quiet_, verbose_;
  Exit code_ = exit_ok;
  std::vector<Part> parts_;
  std::vector<std::string> lacks_;
  std::set<std::string> remarks_;
};

// Starts the port, and checks the first steps of its units in each profile that it supports
// (host/smoke.hpp).
void examine_port(const HostOptions& options, Examination& examination);

// --verbose
void add_verbose(const Command& command, bool& verbose);

}  // namespace attest::cli
