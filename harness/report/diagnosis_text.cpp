#include "harness/report/diagnosis_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/failure_text.hpp"
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

std::string likeness(const Diagnosis& diagnosis) {
  if (!diagnosis.suspects.empty()) {
    std::string out = "it looks like:\n";
    for (const Suspect& suspect : diagnosis.suspects) out += suspect_text(suspect);
    return out;
  }
  if (diagnosis.nearest == nullptr) {
    return fmt::format("it looks like no fault of the catalogue; {}\n", first_stages(diagnosis));
  }
  return fmt::format(
      "it looks like no fault of the catalogue; the nearest is `{}`\n"
      "  ({}; in the stage {}), with {:.0f}% of the deviating values in common\n",
      diagnosis.nearest->id, diagnosis.nearest->what, name_of(*diagnosis.stage),
      100 * diagnosis.jaccard_index);
}

}  // namespace

std::string first_stages(const Diagnosis& diagnosis) {
  return fmt::format("{} of {} deviate first in the {}", diagnosis.in_first_stages,
                     counted(diagnosis.failing, "failing vector"),
                     stages_text(diagnosis.first_stages));
}

std::string diagnosis_text(const Diagnosis& diagnosis) {
  std::string out = likeness(diagnosis);
  if (diagnosis.why.empty()) return out;
  return out + fmt::format(
                   "most specific failing case: {}, which {} of the catalogue would fail\n"
                   "  it tests: {}\n",
                   diagnosis.specific_case, counted(diagnosis.shown_by_it, "fault"),
                   one_line(diagnosis.why));
}

}  // namespace attest
