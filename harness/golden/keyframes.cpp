#include "harness/golden/keyframes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/compare/compare.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

// The samples of `all` at the ticks of `kept`, with the channels of `kept` only; fewer samples
// where a tick of `kept` is not in `all`.
Trace at_ticks_of(const Trace& kept, const Trace& all) {
  Trace chosen;
  chosen.source = all.source;
  chosen.present = kept.present;
  auto sample = all.samples.begin();
  for (const Sample& wanted : kept.samples) {
    sample = std::find_if(sample, all.samples.end(), [&](const Sample& one) {
      return one.in.timestamp == wanted.in.timestamp;
    });
    if (sample == all.samples.end()) break;
    chosen.samples.push_back(*sample);
    chosen.samples.back().in.updated = 0;  // freshness is not kept
  }
  return chosen;
}

}  // namespace

Result<Trace> filled_in(Trace made, const Trace& kept, const Subject& subject, bool is_exact) {
  if (const auto fault = drive(*open_builtin(), subject, made)) {
    return fail_at(kept.source, fmt::format("the reference: {}", fault->what));
  }
  const ChannelSet missing = made.present & channels_of(subject.part, "out/") & ~kept.present;
  if (missing.any()) {
    return fail_at(kept.source, fmt::format("has no {}; bless it anew, or restore it from version "
                                            "control",
                                            channels()[missing._Find_first()].name));
  }
  const Trace chosen = at_ticks_of(kept, made);
  const auto other_input = first_input_difference(chosen, kept);
  if (chosen.samples.size() != kept.samples.size() || other_input) {
    return fail_at(kept.source,
                   "has ticks or inputs that the case does not make; bless it anew, or restore it "
                   "from version control");
  }
  const Tolerances tolerances(is_exact ? Level::exact : Level::numeric);
  if (const auto comparison = compare(chosen, kept, tolerances); comparison.first) {
    const auto& first = *comparison.first;
    return fail_at(
        kept.source,
        fmt::format("at timestamp {} the reference of this build answers another {}; "
                    "bless it anew, or restore it from version control",
                    kept.samples[first.tick].in.timestamp, channels()[first.channel].name));
  }
  return made;
}

}  // namespace attest
