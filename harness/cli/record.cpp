#include <map>
#include <string>

#include <fmt/format.h>

#include "harness/casefile/parse_limits.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/cli/find_case.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/host/file_format.hpp"
#include "harness/verify/fixed_step.hpp"

namespace attest::cli {
namespace {

struct RecordOptions {
  HostOptions host;
  std::string case_name, rate = "250", out = "-";
};

// The case of the same name in the first profile that has it and that the port supports; else
// `the_case`.
Case case_of_port(const RecordOptions& options, Case the_case, const SuiteFolder& suite) {
  for (const std::string& id : ids_for_port(options.case_name, the_case, options.host)) {
    if (auto other = find_open_loop_case(id, suite)) return *std::move(other);
  }
  return the_case;
}

Result<Trace> recorded(const RecordOptions& options, const SuiteFolder& suite) {
  auto the_case = find_open_loop_case(options.case_name, suite);
  if (!the_case) return tl::unexpected(the_case.error());
  the_case = case_of_port(options, *std::move(the_case), suite);
  const auto rate = Rate::parse(options.rate);
  if (!rate) return tl::unexpected(rate.error());
  if (auto few = check_ticks(*the_case, *rate); !few) return tl::unexpected(few.error());
  const auto host = start_host(options.host);
  if (!host) return tl::unexpected(host.error());
  Trace trace = inputs_for((*host)->declarations(), *the_case, *rate);
  const auto fault = (*host)->drive(subject_of(*the_case), trace);
  if (!fault) return trace;
  const auto cases_of = [](const std::string& profile, const std::string& port) {
    return fmt::format("attest record CASE{}, with a CASE of `attest list --profile {}`", port,
                       profile);
  };
  return tl::unexpected(
      supported_instead(options.host, {the_case->profile}, cases_of)
          .value_or(fail_at(options.host.port, fmt::format("{}: {}", trace.source, fault->what))
                        .value()));
}

Result<void> record(const RecordOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return tl::unexpected(suite.error());
  const auto checked =
      check_outputs({options.out}, {options.host.port, {options.case_name}}, globals.suite);
  if (!checked) return tl::unexpected(checked.error());
  auto file = AtomicFile::open(options.out);
  if (!file) return tl::unexpected(file.error());
  const auto trace = recorded(options, *suite);
  if (!trace) return tl::unexpected(trace.error());
  return write_trace(*std::move(file), *trace);
}

int record_command(const RecordOptions& options, const Globals& globals) {
  const auto written = record(options, globals);
  return written ? exit_ok : report_error(written.error());
}

}  // namespace

void add_record(const CommandLine& line) {
  auto options = std::make_shared<RecordOptions>();
  const Command command =
      line.add("record", "Write the inputs and outputs of a port in one open-loop case as a trace");
  command.option("case,--case", options->case_name, "The case: its name or id, or a case file")
      .type("CASE")
      .required()
      .rewritten(full_case_name);
  command.option("--rate", options->rate, "The loop rate [Hz]").type("HZ").shows_default();
  add_port(command, options->host);
  add_port_argument(command, options->host);
  command
      .option(
          "--out", options->out,
          fmt::format("Write the trace as CSV, or in the format of the name's ending ({}); `-` is "
                      "stdout",
                      written_endings()))
      .type("F")
      .shows_default();
  add_timeout(command, options->host.timeout_s);
  command.examples({{"attest record rates/p_alone ./libmine.so --out mine.csv",
                     "write a trace for `attest plot`, `replay` or `compare`"}});
  command.runs(options, record_command);
}

}  // namespace attest::cli
