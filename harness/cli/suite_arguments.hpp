// The arguments of the commands about the suite: faults, list, vectors, bless.
#pragma once

#include "harness/cli/shared_arguments.hpp"

namespace attest::cli {

// REQUIRES: `globals` and `action` live as long as `app`.
void add_suite_commands(CLI::App& app, const Globals& globals, Action& action);

}  // namespace attest::cli
