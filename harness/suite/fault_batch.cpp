#include "harness/suite/fault_batch.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>

#include "harness/port/fault_port.hpp"
#include "harness/suite/evaluate.hpp"

namespace attest {
namespace {

// A case at a rate, by how likely it is to catch: own group, then 250 Hz, then in order.
struct Attempt {
  const Case* the_case;
  Rate rate;
  int turn;
};

std::vector<Attempt> attempts(const std::vector<SelectedCase>& cases, std::string_view group) {
  std::vector<Attempt> list;
  for (const auto& [the_case, setups] : cases) {
    for (const Setup& setup : setups) {
      const int turn = (the_case.group == group ? 0 : 2) + (setup.rate == Rate::hz(250) ? 0 : 1);
      list.push_back({&the_case, setup.rate, turn});
    }
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const Attempt& a, const Attempt& b) { return a.turn < b.turn; });
  return list;
}

}  // namespace

// One for each vector.
std::size_t FaultBatch::most_parts() const {
  return std::accumulate(
      cases_.begin(), cases_.end(), std::size_t{0},
      [](std::size_t sum, const SelectedCase& one) { return sum + one.setups.size(); });
}

CaseResult FaultBatch::identity(std::size_t) const {
  CaseResult result;
  result.profile = name_of(profile_);
  result.group = fault_.group;
  result.name = fault_.id;
  return result;
}

Result<CaseResult> FaultBatch::evaluate(std::size_t i, Port&) {
  auto port = open_fault(fault_.id, fraction_bits_);
  if (!port) return tl::unexpected(port.error());
  CaseResult found = identity(i);
  // Of a module that the profile's cases do not have.
  const bool has_group = std::any_of(cases_.begin(), cases_.end(), [&](const SelectedCase& one) {
    return one.the_case.group == fault_.group;
  });
  if (!has_group && !fault_.is_killable(profile_)) return found;
  std::optional<Golden> golden;
  const Case* opened = nullptr;
  for (const auto& [the_case, rate, turn] : attempts(cases_, fault_.group)) {
    if (opened != the_case) {
      auto next = Golden::open(golden_root_, *the_case);
      if (!next) return tl::unexpected(next.error());
      golden.emplace(std::move(*next));
      opened = the_case;
    }
    // Rounding tells a fault from the law that is equivalent to it.
    if (the_case->exact_only && !fault_.is_killable(profile_)) continue;
    begin_part();
    const Level level = the_case->exact_only ? Level::exact : Level::numeric;
    const auto result = evaluate_case(*the_case, rate, *golden, **port, level);
    if (!result) return tl::unexpected(result.error());
    if (!fails_a_run(result->verdict)) continue;
    found.verdict = result->verdict;
    found.first = result->first;
    found.rate = rate;
    found.reason = result->id();
    return found;
  }
  return found;
}

}  // namespace attest
