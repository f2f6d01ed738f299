// The arguments of the commands about time: stress, sweep-rate, schedule, time.
#pragma once

#include <functional>

#include "harness/cli/command.hpp"

namespace CLI {
class App;
}

namespace attest::cli {

// The work of the command that was chosen; its result is the exit code.
using Action = std::function<int()>;

// Options that several commands have: --filter and its kin, --port, --timeout.
void add_selection(CLI::App& command, SelectionOptions& options);
void add_port(CLI::App& command, std::string& port);
void add_timeout(CLI::App& command, double& timeout_s);

// REQUIRES: `globals` and `action` live as long as `app`.
void add_timing_commands(CLI::App& app, const Globals& globals, Action& action);

}  // namespace attest::cli
