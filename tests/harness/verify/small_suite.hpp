// Cases and goldens that a test makes, and the options to run a port on them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/verify/case_job.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {

// "lib:.../port_<name>.so" of tests/ports.
std::string test_port(const std::string& name);
HostOptions host_of(const std::string& port);  // as for open_port

class SmallSuite {
 public:
  // A case of 30 ticks at 100 and 250 Hz, with its golden.
  void add(std::string_view name, std::string_view body);
  // One without a golden.
  void add_unblessed(std::string_view name, std::string_view body);
  // Three that the reference passes: the vehicle pitches in `pitch`, which is the second.
  void add_three();

  std::filesystem::path folder() const { return files_.folder(); }
  std::filesystem::path golden() const { return files_.folder().parent_path() / "golden"; }
  const Case& operator[](std::size_t i) const { return cases_[i]; }

  JobResults<VectorResult> run(const HostOptions& host, int processes = 1) const;

 private:
  CaseFiles files_;
  std::vector<Case> cases_;
};

// One line a result: id, verdict, reason, first deviation; and one an error.
std::vector<std::string> lines_of(const JobResults<VectorResult>& outcome);

}  // namespace attest
