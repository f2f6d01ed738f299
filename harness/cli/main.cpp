// attest: is this port the same attitude controller as the reference?
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/core/version.hpp"

namespace {

constexpr const char* description =
    "Says whether a port of the PX4 multicopter attitude controller is the same controller as the\n"
    "reference, at every loop rate, and if not: at which tick, on which signal, in which stage.\n";

constexpr const char* footer =
    "\nFirst steps:\n"
    "  attest run                                     the built-in reference, all cases and rates\n"
    "  attest run --port lib:./libmine.so             your port\n"
    "  attest run --port lib:./libmine.so --level exact --filter 'attitude/*@250hz'\n"
    "  attest replay TRACE.csv --port lib:./libmine.so\n"
    "\n"
    "Exit codes: 0 nothing failed, 1 something did not conform, 2 usage or environment.\n";

int run(int argc, char** argv) {
  using namespace attest::cli;
  CLI::App app(description, "attest");
  app.set_version_flag("--version", fmt::format("attest {}", attest::version));
  app.footer(footer);
  app.require_subcommand(1);
  app.fallthrough();

  Globals globals;
  app.add_option("--suite", globals.suite, "Folder with cases/ and golden/")->type_name("DIR");
  app.add_flag("-q,--quiet", globals.quiet, "No progress and no summary, only what went wrong");

  Action action;
  add_run(app, globals, action);
  add_replay(app, globals, action);
  add_compare(app, globals, action);
  add_list(app, globals, action);
  add_vectors(app, globals, action);
  add_bless(app, globals, action);
  add_doctor(app, globals, action);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return exit_usage;
  }
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    // Out of memory, or a bug of ours.
    fmt::print(stderr, "attest: error: {}\n", error.what());
    return attest::cli::exit_usage;
  }
}
