#include "harness/golden/golden_change.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>

#include <fmt/format.h>

#include "harness/core/file.hpp"

namespace attest {
namespace {

// The changes that blessing makes in a trace, or in all traces of a case.
struct Change {
  ChannelSet channels;
  std::size_t ticks = 0;
  double max_deviation = 0;
  std::size_t max_channel = 0;
};

// By bits, as at the exact level: -0 differs from 0, but all NaNs are equal.
bool differ(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) != std::isnan(b);
  return a != b || std::signbit(a) != std::signbit(b);
}

// Infinite if one value is NaN.
double deviation(double a, double b) {
  const double difference = std::abs(a - b);
  return std::isnan(difference) ? HUGE_VAL : difference;
}

// Compares every channel, inputs included, at the ticks that both traces have. Each further tick
// counts as changed.
Change change_between(const Trace& old_trace, const Trace& new_trace) {
  Change change;
  const std::size_t common = std::min(old_trace.samples.size(), new_trace.samples.size());
  for (std::size_t tick = 0; tick < common; ++tick) {
    bool differs = false;
    for (std::size_t i = 0; i < channels().size(); ++i) {
      if (!old_trace.present[i] && !new_trace.present[i]) continue;
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

// The entries of a provenance about flights, in addition to their traces.
struct Measured {
  std::map<std::string, double> horizon_s, metrics;
  std::map<std::string, std::string> models;

  bool operator==(const Measured&) const = default;
};

Measured measured_in(const MadeGolden& made) {
  Measured all;
  for (const GoldenTrace& trace : made.traces) {
    if (trace.horizon_s) all.horizon_s[trace.configuration.label()] = *trace.horizon_s;
    for (const auto& [metric, value] : trace.metrics) {
      all.metrics[metric_key(trace.configuration, metric)] = value;
    }
  }
  for (const auto& file : made.vehicle_files) {
    all.models[file.filename().string()] = sha256_of_file(file).value_or("");
  }
  return all;
}

// The sum of the changes of all traces of a case.
class Changes {
 public:
  void add(const Trace& old_trace, const Trace& trace) {
    const Change change = change_between(old_trace, trace);
    if (change.ticks == 0) return;
    ++traces_;
    total_.channels |= change.channels;
    total_.ticks += change.ticks;
    if (change.max_deviation <= total_.max_deviation) return;
    total_.max_deviation = change.max_deviation;
    total_.max_channel = change.max_channel;
  }
  void add_replaced() { ++replaced_; }

  bool empty() const { return traces_ + replaced_ == 0; }
  std::string to_string(std::size_t of) const {
    std::string out;
    if (traces_ > 0) {
      out = fmt::format("{} of {} traces, {} ticks, {} signals; at most by {:.3g} in {}", traces_,
                        of, total_.ticks, total_.channels.count(), total_.max_deviation,
                        channels()[total_.max_channel].name);
    }
    if (replaced_ == 0) return out;
    return fmt::format("{}{}{} of {} traces are replaced", out, out.empty() ? "" : "; ", replaced_,
                       of);
  }

 private:
  std::size_t traces_ = 0, replaced_ = 0;
  Change total_;
};

Changes changes_of(const Golden& golden, const std::vector<GoldenTrace>& traces) {
  Changes changes;
  for (const GoldenTrace& made : traces) {
    const auto old_trace = golden.read(made.configuration);
    if (old_trace) {
      changes.add(*old_trace, made.trace);
    } else {
      changes.add_replaced();
    }
  }
  return changes;
}

}  // namespace

std::string change_of_golden(const Case& the_case, const MadeGolden& made,
                             const std::filesystem::path& golden_root) {
  Case as_blessed = the_case;
  const auto path = golden_folder(golden_root, the_case) / provenance_name;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return fmt::format("{}: new, {} traces", the_case.id(), made.traces.size());
  }
  const auto provenance = read_provenance(path);
  if (!provenance) {
    return fmt::format("{}: replaced; {}", the_case.id(), provenance.error().to_string());
  }
  as_blessed.sha256 = provenance->case_sha256;  // another version of the case file is no error here
  const auto golden = Golden::open(golden_root, as_blessed);
  if (!golden) return fmt::format("{}: replaced; {}", the_case.id(), golden.error().to_string());

  const Changes changes = changes_of(*golden, made.traces);
  if (!changes.empty()) {
    return fmt::format("{}: {}", the_case.id(), changes.to_string(made.traces.size()));
  }
  if (provenance->case_sha256 != the_case.sha256) {
    return fmt::format("{}: no value changes, the case file did", the_case.id());
  }
  const Measured before{provenance->horizon_s, provenance->metrics, provenance->models};
  const Measured now = measured_in(made);
  if (before == now) return "";
  return fmt::format(
      "{}: no value changes, {}", the_case.id(),
      before.models == now.models ? "horizons or metrics did" : "the vehicle's files did");
}

}  // namespace attest
