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
  CaseChoice choice;
  std::string rate = "250", out = "-";
};

// The case of the same name in the first profile in which the port has it; else `the_case`.
Case case_of_port(const RecordOptions& options, Case the_case, const SuiteFolder& suite,
                  const ModuleSet& modules) {
  for (const CaseChoice& one : choices_for_port(options.choice, the_case, options.host)) {
    auto other = find_open_loop_case(one, suite, modules);
    if (other && contains(modules, other->module)) return *std::move(other);
  }
  return the_case;
}

struct Recorded {
  Trace trace;
  std::string what;  // "px4-v1.18/rates/d_alone@250hz  32 ticks of rate_unit"
};

// For a name that is also that of a group: "; `attest list --group landed` shows ..."
std::string hint_for_group(const std::string& name, const SuiteFolder& suite) {
  Selection selection;
  selection.groups = {name};
  if (!select_cases(suite.case_folders(), selection)) return "";
  return fmt::format("; `attest list --group {}` shows the group of this name", name);
}

Result<Recorded> recorded(const RecordOptions& options, const SuiteFolder& suite) {
  const auto host = start_host(options.host);
  if (!host) return tl::unexpected(host.error());
  const ModuleSet modules = (*host)->declarations().modules;
  auto the_case = find_open_loop_case(options.choice, suite, modules);
  if (!the_case) return tl::unexpected(the_case.error());
  the_case = case_of_port(options, *std::move(the_case), suite, modules);
  const auto rate = Rate::parse(options.rate);
  if (!rate) return tl::unexpected(rate.error());
  if (auto few = check_ticks(*the_case, *rate); !few) return tl::unexpected(few.error());
  Trace trace = inputs_for((*host)->declarations(), *the_case, *rate);
  const auto fault = (*host)->drive(subject_of(*the_case), trace);
  if (!fault) {
    std::string what = fmt::format("{}@{}  {} ticks of {}", the_case->id(), rate->label(),
                                   trace.samples.size(), name_of(the_case->module));
    return Recorded{std::move(trace), std::move(what)};
  }
  const auto cases_of = [](const std::string& profile, const std::string& port) {
    return fmt::format("attest record CASE{}, with a CASE of `attest list --profile {}`", port,
                       profile);
  };
  const bool lacks_module = !contains(modules, the_case->module);
  const std::string hint = lacks_module ? hint_for_group(options.choice.name, suite) : "";
  return tl::unexpected(
      supported_instead(options.host, {the_case->profile}, cases_of)
          .value_or(
              fail_at(options.host.port, fmt::format("{}: {}{}", trace.source, fault->what, hint))
                  .value()));
}

Result<void> record(const RecordOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return tl::unexpected(suite.error());
  const auto checked =
      check_outputs({options.out}, {options.host.port, {options.choice.name}}, globals.suite);
  if (!checked) return tl::unexpected(checked.error());
  auto file = AtomicFile::open(options.out);
  if (!file) return tl::unexpected(file.error());
  const auto trace = recorded(options, *suite);
  if (!trace) return tl::unexpected(trace.error());
  auto written = write_trace(*std::move(file), trace->trace);
  if (written && !globals.quiet && options.out != "-") {
    fmt::print("{} -> {}\n", trace->what, options.out);
  }
  return written;
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
  add_case(command, options->choice, "case,--case", "The case: its name or id, or a case file")
      .required();
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
