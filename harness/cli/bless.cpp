#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/cli/command.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/golden/branch_alternatives.hpp"
#include "harness/golden/golden.hpp"
#include "harness/golden/golden_lock.hpp"
#include "harness/golden/keyframes.hpp"
#include "harness/golden/reference_flight.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/port/port.hpp"
#include "harness/verify/recorded_check.hpp"

namespace attest::cli {
namespace {

// What was written so far is removed on the way out.
Result<void> check_not_interrupted() {
  if (interrupted()) return fail("interrupted; no golden was changed");
  return {};
}

// A golden that only our own code has seen proves nothing: the reference must first agree with what
// the firmware computed.
Result<void> check_reference(const SuiteFolder& suite) {
  const auto check = check_recorded(suite.recorded());
  if (!check) return tl::unexpected(check.error());
  if (check->conforming == check->traces) return {};
  return fail(
      fmt::format("nothing is blessed: the reference of this build differs from {} of {} "
                  "traces recorded from the firmware; first: {}",
                  check->traces - check->conforming, check->traces, check->first_difference));
}

// Who blesses has to know which goldens only our own code has seen.
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

Result<GoldenTrace> open_loop_trace(const Case& the_case, const RunConfiguration& configuration,
                                    Port& port) {
  Trace trace = stimulate(the_case, configuration.rate);
  if (const auto fault = drive(port, subject_of(the_case), trace)) {
    return fail_at(the_case.file.string(), fmt::format("the reference: {}", fault->what));
  }
  GoldenTrace golden{configuration, std::move(trace)};
  auto others = branch_alternatives(the_case, golden.trace);
  if (!others) return tl::unexpected(others.error());
  golden.branch_alternatives = std::move(*others);
  golden.is_whole = keeps_every_tick(golden.trace.samples.size());
  if (!golden.is_whole) golden.trace = keyframes_of(golden.trace);
  return golden;
}

// What the reference makes of a case, and the vehicles' files that it depends on.
struct Reference {
  std::vector<GoldenTrace> traces;
  std::vector<std::filesystem::path> vehicle_files;
};

Result<Reference> reference_of(const Case& the_case, Port& port, VehicleModels& vehicle_models) {
  Reference reference;
  std::set<std::filesystem::path> files;
  for (const RunConfiguration& configuration :
       the_case.configurations()) {  // a provenance speaks of all of them
    if (auto go_on = check_not_interrupted(); !go_on) return tl::unexpected(go_on.error());
    if (!configuration.plant_configuration) {
      auto trace = open_loop_trace(the_case, configuration, port);
      if (!trace) return tl::unexpected(trace.error());
      reference.traces.push_back(std::move(*trace));
      continue;
    }
    const auto vehicle_model = vehicle_models.get(configuration.plant_configuration->vehicle);
    if (!vehicle_model) return tl::unexpected(vehicle_model.error());
    auto flight = reference_flight(the_case, configuration, **vehicle_model);
    if (!flight) return tl::unexpected(flight.error());
    reference.traces.push_back({configuration, std::move(flight->rows), false, flight->horizon_s,
                                std::move(flight->metrics)});
    for (auto& file : (*vehicle_model)->vehicle().files()) files.insert(std::move(file));
  }
  reference.vehicle_files.assign(files.begin(), files.end());
  return reference;
}

// What blessing would change in one trace, beside the traces that do not change.
struct Change {
  ChannelSet channels;
  std::size_t ticks = 0;
  double max_deviation = 0;
  std::size_t max_channel = 0;
};

// By bits, as the exact level sees it: -0 is not 0, but every NaN is the same.
bool differ(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) != std::isnan(b);
  return a != b || std::signbit(a) != std::signbit(b);
}

// Infinite where one of them is no number.
double deviation(double a, double b) {
  const double difference = std::abs(a - b);
  return std::isnan(difference) ? HUGE_VAL : difference;
}

// Of every channel, inputs too, over the ticks that both have.
Change change_between(const Trace& old_trace, const Trace& new_trace) {
  Change change;
  const std::size_t common = std::min(old_trace.samples.size(), new_trace.samples.size());
  for (std::size_t tick = 0; tick < common; ++tick) {
    bool differs = false;
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const double before = value_of(channels()[i], old_trace.samples[tick]);
      const double after = value_of(channels()[i], new_trace.samples[tick]);
      if (!differ(before, after)) continue;
      differs = true;
      change.channels.set(i);
      const double off = deviation(before, after);
      if (off <= change.max_deviation) continue;
      change.max_deviation = off;
      change.max_channel = i;
    }
    change.ticks += differs ? 1 : 0;
  }
  change.ticks += std::max(old_trace.samples.size(), new_trace.samples.size()) - common;
  return change;
}

// One line about a case; empty when its golden is what would be written now.
std::string summary(const Case& the_case, const std::vector<GoldenTrace>& traces,
                    const std::filesystem::path& golden_root) {
  Case as_blessed = the_case;
  const auto path = golden_folder(golden_root, the_case) / provenance_name;
  const auto provenance = read_provenance(path);
  if (!provenance) return fmt::format("{}: new, {} traces", the_case.id(), traces.size());
  as_blessed.sha256 = provenance->case_sha256;  // what it was made from does not matter here
  const auto golden = Golden::open(golden_root, as_blessed);
  if (!golden) return fmt::format("{}: replaced; {}", the_case.id(), golden.error().to_string());

  std::size_t changed = 0;
  Change total;
  const auto add = [&](const Trace& old_trace, const Trace& trace) {
    const Change change = change_between(old_trace, trace);
    if (change.ticks == 0) return;
    ++changed;
    total.channels |= change.channels;
    total.ticks += change.ticks;
    if (change.max_deviation <= total.max_deviation) return;
    total.max_deviation = change.max_deviation;
    total.max_channel = change.max_channel;
  };
  for (const GoldenTrace& made : traces) {
    const auto old_trace = golden->read(made.configuration);
    const auto old_others = golden->read_branch_alternatives(made.configuration);
    if (!old_trace || !old_others || old_others->size() != made.branch_alternatives.size()) {
      ++changed;
      continue;
    }
    add(*old_trace, made.trace);
    for (const auto& [side, other] : made.branch_alternatives) {
      const auto old_other = old_others->find(side);
      if (old_other != old_others->end()) add(old_other->second, other);
    }
  }
  const bool same_case = provenance->case_sha256 == the_case.sha256;
  if (changed == 0 && same_case) return "";
  if (changed == 0) return fmt::format("{}: no value changes, the case file did", the_case.id());
  return fmt::format("{}: {} of {} traces, {} ticks, {} channels; at most by {:.3g} in {}",
                     the_case.id(), changed, traces.size(), total.ticks, total.channels.count(),
                     total.max_deviation, channels()[total.max_channel].name);
}

// Everything written beside its place, and what would change.
struct Pending {
  std::vector<NewGolden> goldens;
  std::size_t unchanged = 0;
};

// What makes a golden, and where it goes.
struct Blessing {
  Port& port;
  VehicleModels& vehicle_models;
  std::filesystem::path golden_root;
  std::string reason;
};

// A file with all its profiles: the goldens of the others rest on that of the first.
Result<void> write_file_beside(const Case& first, Blessing& blessing, Pending& pending) {
  Reference of_first;
  std::filesystem::path base_folder = golden_folder(blessing.golden_root, first);
  bool base_changes = false;
  for (const std::string& profile : first.profiles) {
    const Case the_case = first.in_profile(profile);
    auto reference = reference_of(the_case, blessing.port, blessing.vehicle_models);
    if (!reference) return tl::unexpected(reference.error());
    const bool is_first = the_case.is_of_first_profile();
    if (is_first) of_first = *reference;
    std::string line = summary(the_case, reference->traces, blessing.golden_root);
    if (line.empty() && base_changes && !the_case.flight)
      line = fmt::format("{}: its base changes", the_case.id());
    if (line.empty()) {
      ++pending.unchanged;
      continue;
    }
    fmt::print("{}\n", line);
    const GoldenBase base{of_first.traces, base_folder};
    // Ticks that are kept are not those that another profile keeps.
    const bool rests_on_base =
        !is_first && std::all_of(reference->traces.begin(), reference->traces.end(),
                                 [](const GoldenTrace& trace) { return trace.is_whole; });
    auto golden = NewGolden::write(blessing.golden_root, the_case, reference->traces,
                                   reference->vehicle_files, blessing.reason,
                                   rests_on_base ? &base : nullptr);
    if (!golden) return tl::unexpected(golden.error());
    if (is_first) {
      base_folder = golden->written();
      base_changes = true;
    }
    pending.goldens.push_back(std::move(*golden));
  }
  return {};
}

Result<Pending> write_beside(const std::vector<SelectedCase>& cases, const SuiteFolder& suite,
                             const std::string& reason) {
  auto port = open_port("builtin");
  if (!port) return tl::unexpected(port.error());
  VehicleModels vehicle_models(suite.models());
  Blessing blessing{**port, vehicle_models, suite.golden(), reason};
  Pending pending;
  std::set<std::filesystem::path> done;
  for (const SelectedCase& selected : cases) {
    const Case& the_case = selected.the_case;
    if (!done.insert(the_case.file).second) continue;
    const Case first = the_case.in_profile(the_case.profiles.front());
    if (auto written = write_file_beside(first, blessing, pending); !written) {
      return tl::unexpected(written.error());
    }
  }
  return pending;
}

bool confirmed(const BlessOptions& options, std::size_t count) {
  if (options.yes) return true;
  fmt::print("replace the golden of {} case{}? [y/N] ", count, count == 1 ? "" : "s");
  std::fflush(stdout);
  constexpr int look_every_ms = 100;  // at whether Ctrl-C was pressed, which does not end getline()
  pollfd terminal{STDIN_FILENO, POLLIN, 0};
  while (!interrupted() && ::poll(&terminal, 1, look_every_ms) <= 0) {
  }
  if (interrupted()) return false;
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "yes";
}

Result<int> bless_selected(const BlessOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return tl::unexpected(suite.error());
  const auto cases = options.select.cases_in(suite->cases());
  if (!cases) return tl::unexpected(cases.error());
  note_interrupts();
  const auto lock = GoldenLock::take(suite->golden());
  if (!lock) return tl::unexpected(lock.error());
  if (auto checked = check_reference(*suite); !checked) return tl::unexpected(checked.error());
  if (auto noted = note_uncovered(*cases, *suite); !noted) return tl::unexpected(noted.error());
  auto pending = write_beside(*cases, *suite, options.reason);
  if (!pending) return tl::unexpected(pending.error());

  if (pending->unchanged > 0) fmt::print("{} unchanged\n", pending->unchanged);
  if (pending->goldens.empty()) return exit_ok;
  const bool wanted = confirmed(options, pending->goldens.size());
  if (auto go_on = check_not_interrupted(); !go_on) return tl::unexpected(go_on.error());
  if (!wanted) {
    fmt::print("nothing was changed\n");
    return exit_failed;
  }
  for (NewGolden& golden : pending->goldens) {
    if (auto placed = golden.put_in_place(); !placed) return tl::unexpected(placed.error());
  }
  fmt::print("blessed {}\n", pending->goldens.size());
  return exit_ok;
}

}  // namespace

int bless_command(const BlessOptions& options, const Globals& globals) {
  if (options.reason.empty()) {
    return report_error({"say why with --reason \"...\"; it is kept in provenance.toml"});
  }
  if (!options.yes && !::isatty(STDIN_FILENO)) {
    return report_error({"nobody is there to ask; pass --yes to replace goldens unasked"});
  }
  const auto code = bless_selected(options, globals);
  if (code) return *code;
  report_error(code.error());
  return interrupted() ? exit_interrupted : exit_usage;
}

}  // namespace attest::cli
