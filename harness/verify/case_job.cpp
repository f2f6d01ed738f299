#include "harness/verify/case_job.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {

std::string Codec<CaseResult>::encode(const Result<CaseResult>& result) {
  return attest::encode(result.map([](const CaseResult& one) { return to_json(one); }));
}

Result<CaseResult> Codec<CaseResult>::decode(const std::string& text) {
  return attest::decode(text).and_then(case_result_from_json);
}

Result<void> CaseJob::open() {
  auto host = start_host(options_, {&case_, airframe_.get()});
  if (!host) return tl::unexpected(host.error());
  host_ = *std::move(host);
  auto golden = Golden::open(golden_root_, case_);
  if (!golden) return tl::unexpected(golden.error());
  golden_.emplace(*std::move(golden));
  return {};
}

Result<CaseResult> CaseJob::run(std::size_t task) {
  const Setup& setup = setups_[task];
  if (!airframe_) return evaluate_case(case_, setup.rate, *golden_, *host_, level_);
  return evaluate_flight(case_, setup, *airframe_, *golden_, *host_);
}

Result<CaseResult> TimedJob::run(std::size_t) {
  const auto host = start_host(options_, {&case_, airframe_.get()});
  if (!host) return tl::unexpected(host.error());
  return evaluate_timed_flight(case_, timing_.setup, *airframe_, timing_.ticks, **host);
}

Result<Jobs<CaseResult>> case_jobs(const std::vector<SelectedCase>& cases,
                                   const std::filesystem::path& golden_root, Fleet& fleet,
                                   Level level, const HostOptions& options) {
  Jobs<CaseResult> jobs;
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
      jobs.push_back(std::make_unique<CaseJob>(the_case, std::vector(begin, end), airframe,
                                               golden_root, level, options));
      begin = end;
    }
  }
  return jobs;
}

}  // namespace attest
