#include "harness/suite/batch.hpp"

#include <algorithm>

#include "harness/suite/evaluate.hpp"

namespace attest {

CaseResult CaseBatch::identity(std::size_t i) const { return unjudged(case_, setups_[i]); }

Result<void> CaseBatch::open() {
  auto golden = Golden::open(golden_root_, case_);
  if (!golden) return tl::unexpected(golden.error());
  golden_.emplace(std::move(*golden));
  return {};
}

Result<CaseResult> CaseBatch::evaluate(std::size_t i, Port& port) {
  if (!airframe_) return evaluate_case(case_, setups_[i].rate, *golden_, port, level_);
  return evaluate_flight(case_, setups_[i], *airframe_, *golden_, port);
}

Result<std::vector<std::unique_ptr<Batch>>> make_batches(const std::vector<SelectedCase>& cases,
                                                         const std::filesystem::path& golden_root,
                                                         Fleet& fleet, Level level) {
  std::vector<std::unique_ptr<Batch>> batches;
  for (const auto& [the_case, setups] : cases) {
    for (auto begin = setups.begin(); begin != setups.end();) {
      const auto end = std::find_if(
          begin, setups.end(), [&](const Setup& setup) { return setup.flyer != begin->flyer; });
      std::shared_ptr<const Airframe> airframe;
      if (begin->flyer) {
        auto loaded = fleet.get(begin->flyer->vehicle);
        if (!loaded) return tl::unexpected(loaded.error());
        airframe = *loaded;
      }
      batches.push_back(std::make_unique<CaseBatch>(the_case, std::vector(begin, end), airframe,
                                                    golden_root, level));
      begin = end;
    }
  }
  return batches;
}

CaseResult TimedBatch::identity(std::size_t) const { return unjudged(case_, timing_.setup); }

Result<CaseResult> TimedBatch::evaluate(std::size_t, Port& port) {
  return evaluate_timed_flight(case_, timing_.setup, *airframe_, timing_.ticks, port);
}

CaseResult TraceBatch::identity(std::size_t) const { return unjudged(recorded_, subject_.profile); }

Result<CaseResult> TraceBatch::evaluate(std::size_t, Port& port) {
  return evaluate_trace(recorded_, subject_, port, tolerances_);
}

}  // namespace attest
