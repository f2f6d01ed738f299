#include "harness/golden/golden_change.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace attest {
namespace {

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

}  // namespace

std::string change_of_golden(const Case& the_case, const std::vector<GoldenTrace>& traces,
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
    for (const auto& [branch, other] : made.branch_alternatives) {
      const auto old_other = old_others->find(branch);
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

}  // namespace attest
