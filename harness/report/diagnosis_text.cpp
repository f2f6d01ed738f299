#include "harness/report/diagnosis_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/text.hpp"

namespace attest {
namespace {

std::string suspect_text(const Suspect& suspect) {
  const faults::Fault& fault = *suspect.fault;
  const std::string with =
      suspect.with ? fmt::format(", together with `{}`", suspect.with->id) : std::string();
  std::string out = fmt::format(
      "  `{}`{}: {} ({}; in the stage {})\n"
      "      matches on {} of {} ticks, and on every tick of {} of {}\n",
      fault.id, with, fault.what, fault.kind, name_of(fault.stage), suspect.matched, suspect.ticks,
      suspect.explained, counted(suspect.failing, "failing vector"));
  if (suspect.ambiguity_group.empty()) return out;
  std::vector<std::string> others;
  for (const faults::Fault* other : suspect.ambiguity_group)
    others.push_back(fmt::format("`{}`", other->id));
  return out + fmt::format("      equally well: {}\n", fmt::join(others, ", "));
}

}  // namespace

std::string diagnosis_text(const Diagnosis& diagnosis) {
  if (diagnosis.suspects.empty()) {
    return fmt::format(
        "it looks like no fault of the catalogue; the nearest is `{}`\n"
        "  ({}; in the stage {}), with {:.0f}% of the deviating values in common\n",
        diagnosis.nearest->id, diagnosis.nearest->what, name_of(diagnosis.stage),
        100 * diagnosis.jaccard_index);
  }
  std::string out = "it looks like:\n";
  for (const Suspect& suspect : diagnosis.suspects) out += suspect_text(suspect);
  return out;
}

}  // namespace attest
