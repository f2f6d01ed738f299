#include "harness/suite/diagnosis_batch.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/casefile/stimulus.hpp"
#include "harness/core/float_environment.hpp"
#include "harness/port/builtin.hpp"
#include "harness/run/open_loop.hpp"
#include "harness/run/other_side.hpp"
#include "harness/suite/evaluate.hpp"
#include "harness/suite/fixed_step.hpp"
#include "harness/suite/judge.hpp"

namespace attest {
namespace {

// Enough to tell the mistakes of the catalogue apart, in a second or two.
constexpr std::size_t most_vectors = 48;

struct Vector {
  const Case* the_case;
  Rate rate;
};

double distance_from_250(const Rate& rate) { return std::abs(std::log(rate.period_s() * 250)); }

// One of each case, at the rate nearest to 250 Hz of those results that are `wanted`.
template <typename Wanted>
std::vector<Vector> vectors_of(const std::vector<SelectedCase>& cases,
                               const std::vector<CaseResult>& results, Wanted wanted) {
  std::map<std::string, Rate> nearest;
  for (const CaseResult& result : results) {
    if (result.flyer || !wanted(result)) continue;
    const auto [place, is_new] = nearest.try_emplace(result.case_id(), result.rate);
    if (!is_new && distance_from_250(result.rate) < distance_from_250(place->second)) {
      place->second = result.rate;
    }
  }
  std::vector<Vector> vectors;
  for (const SelectedCase& selected : cases) {
    const auto found = nearest.find(selected.the_case.id());
    if (found == nearest.end() || is_long(selected.the_case)) continue;
    vectors.push_back({&selected.the_case, found->second});
  }
  return vectors;
}

void add_spread(const std::vector<Vector>& vectors, const faults::Fault* partner,
                std::vector<std::unique_ptr<Batch>>& batches) {
  const std::size_t count = std::min(vectors.size(), most_vectors);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [the_case, rate] = vectors[i * vectors.size() / count];
    batches.push_back(std::make_unique<DiagnosisBatch>(*the_case, rate, partner));
  }
}

}  // namespace

CaseResult DiagnosisBatch::identity(std::size_t) const {
  return unjudged(case_, {rate_, std::nullopt});
}

Result<CaseResult> DiagnosisBatch::evaluate(std::size_t i, Port& port) {
  CaseResult result = identity(i);
  const Case& given = has_fixed_step(port, case_) ? from_one_period_on(case_) : case_;
  Trace law = [&] {
    const DefaultFloatEnvironment environment;
    return stimulate(given, rate_);
  }();
  Trace got = law;
  const Subject subject = subject_of(case_);
  if (declines(port, result) || drive(port, subject, got)) return result;
  const DefaultFloatEnvironment environment;
  const auto reference = open_builtin();
  if (drive(*reference, subject, law)) return result;
  if (case_.either_side.any()) {
    const auto others = other_sides(case_, law);
    if (!others) return tl::unexpected(others.error());
    law = on_the_side_of(
        got, law, *others,
        tolerances_of(case_, Level::numeric, port.fraction_bits(), law.samples.size()));
  }
  result.likeness =
      likeness(outputs_of(got), outputs_of(law), answers_of_faults(law, subject, partner_));
  return result;
}

std::vector<std::unique_ptr<Batch>> diagnosis_batches(const std::vector<SelectedCase>& cases,
                                                      const std::vector<CaseResult>& results,
                                                      const faults::Fault* partner) {
  const auto failed = [](const CaseResult& result) {
    return result.first && fails_a_run(result.verdict);
  };
  const auto passed = [](const CaseResult& result) { return result.verdict == Verdict::pass; };
  std::vector<std::unique_ptr<Batch>> batches;
  const auto failing = vectors_of(cases, results, failed);
  if (failing.empty()) return batches;
  add_spread(failing, partner, batches);
  add_spread(vectors_of(cases, results, passed), partner, batches);
  return batches;
}

}  // namespace attest
