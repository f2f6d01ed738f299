// What the commands have in common: exit codes, messages, and the options that several take.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/core/result.hpp"
#include "harness/suite/select.hpp"

namespace attest::cli {

enum Exit : int {
  exit_ok = 0,
  exit_failed = 1,        // something did not conform
  exit_usage = 2,         // wrong usage, or the environment: files, ports, goldens
  exit_interrupted = 130  // Ctrl-C, as a shell reports it
};

// The options before the command.
struct Globals {
  std::string suite;   // folder with cases/ and golden/; empty: found
  bool quiet = false;  // no progress, no summary: failures, errors and the exit code only
};

// The work of the command that was chosen; its result is the exit code.
using Action = std::function<int()>;

// Each adds one command, which sets `action` when it is chosen. `globals` is read when the action
// runs.
void add_list(CLI::App& app, const Globals& globals, Action& action);
void add_run(CLI::App& app, const Globals& globals, Action& action);
void add_replay(CLI::App& app, const Globals& globals, Action& action);
void add_compare(CLI::App& app, const Globals& globals, Action& action);
void add_vectors(CLI::App& app, const Globals& globals, Action& action);
void add_bless(CLI::App& app, const Globals& globals, Action& action);
void add_doctor(CLI::App& app, const Globals& globals, Action& action);

// "attest: error: <file:line: message>" on stderr; the exit code for it.
int report_error(const Error& error);

// --filter, --group, --profile, --rate, as text until they are used.
struct SelectionOptions {
  std::vector<std::string> filters, groups, profiles, rates;

  void add_to(CLI::App& command);
  Result<Selection> selection() const;
};

}  // namespace attest::cli
