// The arguments of `attest run` and `attest merge`.
#pragma once

#include "harness/cli/shared_arguments.hpp"

namespace attest::cli {

// REQUIRES: `globals` and `action` live as long as `app`.
void add_run_command(CLI::App& app, const Globals& globals, Action& action);
void add_merge_command(CLI::App& app, const Globals& globals, Action& action);

}  // namespace attest::cli
