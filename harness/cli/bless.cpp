#include <algorithm>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>

#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/golden/blessing.hpp"
#include "harness/golden/golden_lock.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/recorded_check.hpp"

namespace attest::cli {
namespace {

struct BlessOptions {
  SelectionOptions select;
  HostOptions host;
  std::string port;  // its outputs become the goldens; empty: those of attest's reference
  std::string reason;
  bool yes = false;
};

// The error ends the command; the destructor of PendingGoldens removes the files written so far.
Result<void> check_not_interrupted() {
  if (interrupted()) return fail("interrupted; no golden was changed");
  return {};
}

// A golden is only as correct as the reference that computes it. The reference must first agree
// with the recordings of the firmware.
Result<void> check_reference(const SuiteFolder& suite) {
  const auto check = check_recorded(suite.recorded());
  if (!check) return tl::unexpected(check.error());
  if (check->conforming == check->traces) return {};
  return fail(
      fmt::format("no golden is blessed: the reference of this build differs from {} of {} "
                  "traces recorded from the firmware; first: {}",
                  check->traces - check->conforming, check->traces, check->first_difference));
}

// Prints the groups whose goldens no recording of the firmware confirms.
Result<void> note_uncovered(const std::vector<SelectedCase>& cases, const SuiteFolder& suite) {
  const auto covered = covered_groups(suite.recorded());
  if (!covered) return tl::unexpected(covered.error());
  std::set<std::string> uncovered;
  for (const SelectedCase& one : cases) {
    const std::string group = one.the_case.profile + "/" + one.the_case.group;
    if (!covered->contains(group)) uncovered.insert(group);
  }
  if (uncovered.empty()) return {};
  fmt::print(stderr, "attest: note: no recording of the firmware covers {}\n",
             fmt::join(uncovered, ", "));
  return {};
}

bool confirmed(const BlessOptions& options, std::size_t count) {
  if (options.yes) return true;
  fmt::print("replace the golden of {} case{}? [y/N] ", count, count == 1 ? "" : "s");
  std::fflush(stdout);
  constexpr int look_every_ms = 100;  // for Ctrl-C, which does not end getline()
  pollfd terminal{STDIN_FILENO, POLLIN, 0};
  while (!interrupted() && ::poll(&terminal, 1, look_every_ms) <= 0) {
  }
  if (interrupted()) return false;
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "yes";
}

// A suite has one reference: its goldens all come from attest's own reference, or from one port.
Result<void> check_kind(const BlessOptions& options, const Globals& globals,
                        const SuiteFolder& suite) {
  const std::string reference = Goldens(suite.golden()).reference();
  if (options.port.empty()) {
    if (reference.empty()) return {};
    return fail_at(
        suite.golden().string(),
        fmt::format("the reference of this suite is {}; bless it with --port", reference));
  }
  if (globals.suite.empty()) {
    return fail(
        "bless --port makes a suite of your own: name its folder, which has your cases/ or a file "
        "BASE, with --suite DIR");
  }
  const auto goldens = suite_folders_in(suite.golden());
  if (!reference.empty() || !goldens || goldens->empty()) return {};
  return fail_at(
      suite.golden().string(),
      "has goldens of attest's own reference; make a folder of your own with cases/ or a "
      "file BASE, and name that with --suite");
}

// "starter-c 1.0 (lib:./mine.so, SHA-256 ab12...)"
Result<std::string> description_of(HostOptions& port) {
  const auto description = prepare_port(port);
  if (!description) return tl::unexpected(description.error());
  const std::string hash = port.files->sha256();
  return one_line(fmt::format("{} {} ({}{}{})", description->name, description->version, port.port,
                              hash.empty() ? "" : ", SHA-256 ", hash));
}

void print_left_out(const PendingGoldens& pending) {
  for (const auto& [why, cases] : pending.left_out) {
    fmt::print(stderr, "attest: note: {} without golden: {}\n",
               cases == 1 ? "1 case" : fmt::format("{} cases", cases), why);
  }
}

// How the goldens are made: by attest's reference, which is checked first, or by a port.
Result<BlessingOptions> blessing_of(const BlessOptions& options,
                                    const std::vector<SelectedCase>& cases,
                                    const SuiteFolder& suite) {
  BlessingOptions blessing{suite.models(), {options.reason}};
  if (options.port.empty()) {
    if (auto checked = check_reference(suite); !checked) return tl::unexpected(checked.error());
    if (auto noted = note_uncovered(cases, suite); !noted) return tl::unexpected(noted.error());
  } else {
    blessing.port = options.host;
    blessing.port->port = options.port;
    auto description = description_of(*blessing.port);
    if (!description) return tl::unexpected(description.error());
    blessing.making.reference = *std::move(description);
  }
  blessing.on_change = [](const std::string& line) { fmt::print("{}\n", line); };
  blessing.stop = interrupted;
  return blessing;
}

// Errors: cases that are not selected have goldens of another port.
Result<void> check_other_goldens(const std::vector<SelectedCase>& selected, GoldenKeys all,
                                 const std::string& port, const Goldens& goldens) {
  for (const SelectedCase& one : selected) all[one.the_case.profile].erase(key_of(one.the_case));
  for (const auto& [profile, others] : all) {
    const auto& origins = goldens.origins_of(profile);
    if (!origins) return tl::unexpected(origins.error());
    for (const auto& [key, origin] : *origins) {
      if (!others.contains(key) || origin.reference == port) continue;
      return fail_at(goldens.root().string(),
                     fmt::format("the golden of {} is of {}, and a suite has one reference: bless "
                                 "all cases with this port",
                                 id_of(profile, key), origin.reference));
    }
  }
  return {};
}

// Errors: a malformed case file.
Result<GoldenKeys> keys_of_all_cases(const SuiteFolder& suite) {
  const auto all = select_cases(suite.case_folders(), {});
  if (!all) return tl::unexpected(all.error());
  GoldenKeys keys;
  for (const SelectedCase& one : *all) keys[one.the_case.profile].insert(key_of(one.the_case));
  return keys;
}

Result<int> bless_selected(const BlessOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return tl::unexpected(suite.error());
  if (auto changes = check_can_change(suite->root); !changes) {
    return tl::unexpected(changes.error());
  }
  const auto cases = options.select.cases_in(suite->case_folders());
  if (!cases) return tl::unexpected(cases.error());
  if (auto checked = check_kind(options, globals, *suite); !checked) {
    return tl::unexpected(checked.error());
  }
  note_interrupts();
  const auto lock = GoldenLock::take(suite->golden());
  if (!lock) return tl::unexpected(lock.error());
  auto blessing = blessing_of(options, *cases, *suite);
  if (!blessing) return tl::unexpected(blessing.error());
  auto all = keys_of_all_cases(*suite);
  if (!all) return tl::unexpected(all.error());
  blessing->all_cases = *std::move(all);
  const Goldens goldens(suite->golden());
  if (blessing->port) {
    const std::string& port = blessing->making.reference;
    auto same = check_other_goldens(*cases, blessing->all_cases, port, goldens);
    if (!same) return tl::unexpected(same.error());
  }
  auto pending = write_new_goldens(*cases, goldens, *blessing);
  if (auto go_on = check_not_interrupted(); !go_on) return tl::unexpected(go_on.error());
  if (!pending) return tl::unexpected(pending.error());
  if (blessing->port) {
    if (auto same = check_port(*blessing->port); !same) return tl::unexpected(same.error());
  }

  print_left_out(*pending);
  if (pending->unchanged > 0) fmt::print("{} unchanged\n", pending->unchanged);
  if (pending->goldens.size() == 0) return exit_ok;
  const bool wanted = confirmed(options, pending->goldens.size());
  if (auto go_on = check_not_interrupted(); !go_on) return tl::unexpected(go_on.error());
  if (!wanted) {
    fmt::print("no golden was changed\n");
    return exit_failed;
  }
  const auto placed = pending->goldens.put_in_place();
  if (!placed) return tl::unexpected(placed.error());
  fmt::print("blessed {}\n", pending->goldens.size());
  return exit_ok;
}

int bless_command(const BlessOptions& options, const Globals& globals) {
  if (options.reason.empty()) {
    return report_error({"say why with --reason \"...\"; it is kept in provenance.toml"});
  }
  if (!options.select.excludes.empty()) {
    return report_error(
        {"bless replaces the golden of a case at all its rates; select with --filter, --group or "
         "--profile instead of --exclude"});
  }
  if (!options.yes && !::isatty(STDIN_FILENO)) {
    return report_error(
        {"stdin is not a terminal; pass --yes to replace goldens without a question"});
  }
  const auto code = bless_selected(options, globals);
  return code ? *code : report_error(code.error());
}

}  // namespace

void add_bless(const CommandLine& line) {
  auto options = std::make_shared<BlessOptions>();
  const Command command =
      line.add("bless", "Make new golden traces from the reference, after showing the changes");
  add_selection(command, options->select);
  // Hidden: bless_command() refuses it, and says what to use instead.
  command.find("--exclude").group("");
  command
      .option("--reason", options->reason,
              "Reason of the change, which is stored in provenance.toml (required)")
      .type("TEXT");
  command.flag("--yes", options->yes, "Replace the goldens without a question");
  command
      .option("--port", options->port,
              "Make the goldens of --suite DIR from this port; default: from the reference "
              "of attest")
      .type("PORT");
  options->host.barrier = line.globals.barrier;
  add_timeout(command, options->host.timeout_s);
  command.examples({{"attest bless --filter 'px4-v1.5.5/tpa/*' --reason \"...\"",
                     "show the changes, and ask before the goldens are replaced"},
                    {"attest bless --suite ours --port lib:./ours.so --reason \"our law\"",
                     "make the goldens of the suite `ours` from your own law"}});
  command.runs(options, bless_command);
}

}  // namespace attest::cli
