#include "harness/golden/golden_change.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "harness/core/agreement.hpp"
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

// REQUIRES: traces of the same ticks.
Change change_between(const Trace& old_trace, const Trace& new_trace) {
  Change change;
  for (std::size_t tick = 0; tick < new_trace.samples.size(); ++tick) {
    bool differs = false;
    for (std::size_t i = 0; i < channels().size(); ++i) {
      if (!old_trace.present[i] && !new_trace.present[i]) continue;
      const Sample &before = old_trace.samples[tick], &after = new_trace.samples[tick];
      if (same_bits(channels()[i], before, after)) continue;
      differs = true;
      change.channels.set(i);
      const double off = distance(value_of(channels()[i], before), value_of(channels()[i], after));
      if (off <= change.max_deviation) continue;
      change.max_deviation = off;
      change.max_channel = i;
    }
    change.ticks += differs ? 1 : 0;
  }
  return change;
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

const GoldenTrace* trace_of(const std::vector<GoldenTrace>& traces, const std::string& label) {
  for (const GoldenTrace& trace : traces) {
    const auto& all = trace.configurations;
    if (std::find(all.begin(), all.end(), label) != all.end()) return &trace;
  }
  return nullptr;
}

Changes changes_of(const std::vector<GoldenTrace>& old_traces,
                   const std::vector<GoldenTrace>& traces) {
  Changes changes;
  for (const GoldenTrace& made : traces) {
    const GoldenTrace* const old_trace = trace_of(old_traces, made.configurations.front());
    if (old_trace != nullptr && old_trace->ticks == made.ticks) {
      changes.add(old_trace->outputs, made.outputs);
    } else {
      changes.add_replaced();
    }
  }
  return changes;
}

// Whether the old golden has the same horizons and metrics.
bool measures_the_same(const std::vector<GoldenTrace>& old_traces,
                       const std::vector<GoldenTrace>& traces) {
  return std::all_of(traces.begin(), traces.end(), [&](const GoldenTrace& made) {
    const GoldenTrace* const old_trace = trace_of(old_traces, made.configurations.front());
    return old_trace != nullptr && old_trace->horizon_s == made.horizon_s &&
           old_trace->metrics == made.metrics;
  });
}

}  // namespace

Result<std::string> change_of_golden(const Case& the_case, const MadeGolden& made,
                                     const Goldens& goldens) {
  const auto& origins = goldens.origins_of(the_case.profile);
  if (!origins) return tl::unexpected(origins.error());
  const auto origin = origins->find(key_of(the_case));
  if (origin == origins->end()) {
    return fmt::format("{}: new, {} traces", the_case.id(), made.traces.size());
  }
  Case as_blessed = the_case;  // another version of the case file is no error here
  as_blessed.sha256 = origin->second.case_sha256;
  const auto golden = goldens.open(as_blessed);
  if (!golden) return fmt::format("{}: replaced; {}", the_case.id(), golden.error().to_string());

  const Changes changes = changes_of(golden->traces(), made.traces);
  if (!changes.empty()) {
    return fmt::format("{}: {}", the_case.id(), changes.to_string(made.traces.size()));
  }
  const auto no_value_changes = [&](const char* what_does) {
    return fmt::format("{}: no value changes, {}", the_case.id(), what_does);
  };
  if (golden->origin().case_sha256 != the_case.sha256) {
    return no_value_changes("the case file did");
  }
  if (golden->origin().models != made.models) {
    return no_value_changes("the vehicle's files did");
  }
  if (!measures_the_same(golden->traces(), made.traces)) {
    return no_value_changes("horizons or metrics did");
  }
  if (golden->origin().inputs != made.inputs) return no_value_changes("the inputs did");
  return std::string();
}

}  // namespace attest
