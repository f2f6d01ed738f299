#include "tests/harness/verify/small_suite.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/harness/golden/blessed.hpp"

namespace attest {

std::string test_port(const std::string& name) {
  return fmt::format("lib:{}/port_{}.so", ATTEST_TEST_PORTS, name);
}

void SmallSuite::add_unblessed(std::string_view name, std::string_view body) {
  const std::string text = fmt::format(
      "schema = 1\nprofiles = [\"px4-v1.5.5\"]\ngroup = \"tests\"\nwhy = \"a test\"\n"
      "duration_ticks = 30\nrates_hz = [100, 250]\nrates_why = \"two\"\n{}",
      body);
  auto parsed = parse_case(files_.write("tests", name, text));
  ASSERT_TRUE(parsed) << parsed.error().to_string();
  cases_.push_back(*std::move(parsed));
}

void SmallSuite::add(std::string_view name, std::string_view body) {
  add_unblessed(name, body);
  bless(golden(), cases_.back());
}

void SmallSuite::add_three() {
  add("level", "");
  add("pitch",
      "[control_state]\n"
      "pitch_rate = { signal = \"step\", from = 0, to = 0.5, at_ticks = 3 }\n");
  add("roll", "[vehicle_attitude_setpoint]\nq_d = { tilt_deg = 20 }\n");
}

HostOptions host_of(const std::string& port) {
  HostOptions host;
  host.port = port;
  return host;
}

JobResults<VectorResult> SmallSuite::run(const HostOptions& host, int processes) const {
  Jobs<VectorResult> jobs;
  for (const Case& the_case : cases_) {
    const std::vector<SelectedCase> of_job{{the_case, the_case.configurations()}};
    jobs.push_back(std::make_unique<CaseJob>(
        of_job, nullptr, std::make_shared<const Goldens>(golden()), JudgeOptions{}, host));
  }
  JobOptions<VectorResult> options;
  options.processes = processes;
  options.in_process = host.in_process;
  return run_jobs(jobs, options);
}

std::vector<std::string> lines_of(const JobResults<VectorResult>& outcome) {
  std::vector<std::string> lines;
  for (const VectorResult& result : outcome.results) {
    std::string line = fmt::format("{} {} {}", result.id(), name_of(result.verdict), result.reason);
    if (result.first) {
      line += fmt::format("{}@{}: {} for {}", channels()[result.first->channel].name,
                          result.first->tick, result.first->got, result.first->want);
    }
    lines.push_back(line);
  }
  for (const Error& error : outcome.errors) lines.push_back(error.to_string());
  return lines;
}

}  // namespace attest
