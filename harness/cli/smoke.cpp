#include "harness/cli/examination.hpp"
#include "harness/cli/shared_arguments.hpp"

namespace attest::cli {
namespace {

struct SmokeOptions {
  HostOptions host;
  bool verbose = false;
};

int smoke_command(const SmokeOptions& options, const Globals& globals) {
  Examination examination(globals, options.verbose);
  examine_port(options.host, examination);
  return examination.conclude();
}

}  // namespace

void add_smoke(const CommandLine& line) {
  auto options = std::make_shared<SmokeOptions>();
  const Command command =
      line.add("smoke",
               "Check step by step whether a port follows attest_unit.h, or PROTOCOL.md if it "
               "is a program; its law is not judged");
  add_port(command, options->host);
  add_port_argument(command, options->host);
  add_timeout(command, options->host.timeout_s);
  add_verbose(command, options->verbose);
  command.examples(
      {{"attest smoke --port \"proc:python3 my_port.py\"", "the exchange with a program"},
       {"attest smoke --port lib:./libmine.so", "the functions of a shared library"}});
  command.runs(options, smoke_command);
}

}  // namespace attest::cli
