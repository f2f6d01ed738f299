// attest: is this port the same attitude controller as the reference?
#include <exception>

#include <fmt/format.h>

#include "harness/cli/arguments.hpp"
#include "harness/cli/command.hpp"

int main(int argc, char** argv) {
  try {
    return attest::cli::run_command_line(argc, argv);
  } catch (const std::exception& error) {
    // Out of memory, or a bug of ours.
    fmt::print(stderr, "attest: error: {}\n", error.what());
    return attest::cli::exit_usage;
  }
}
