#include "harness/suite/batch.hpp"

#include "harness/suite/evaluate.hpp"

namespace attest {

CaseResult CaseBatch::identity(std::size_t i) const { return unjudged(case_, rates_[i]); }

Result<void> CaseBatch::open() {
  auto golden = Golden::open(golden_root_, case_);
  if (!golden) return tl::unexpected(golden.error());
  golden_.emplace(std::move(*golden));
  return {};
}

Result<CaseResult> CaseBatch::evaluate(std::size_t i, Port& port) {
  return evaluate_case(case_, rates_[i], *golden_, port, level_);
}

CaseResult TraceBatch::identity(std::size_t) const { return unjudged(recorded_, profile_); }

Result<CaseResult> TraceBatch::evaluate(std::size_t, Port& port) {
  return evaluate_trace(recorded_, profile_, port, tolerances_);
}

}  // namespace attest
