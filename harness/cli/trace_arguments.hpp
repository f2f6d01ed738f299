// The options of the commands that read and write traces and logs: replay, record, compare, plot.
#pragma once

#include "harness/cli/shared_arguments.hpp"

namespace attest::cli {

void add_trace_commands(CLI::App& app, const Globals& globals, Action& action);

}  // namespace attest::cli
