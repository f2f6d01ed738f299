#include "harness/verify/case_job.hpp"

#include <algorithm>

#include <fmt/format.h>
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

Result<void> CaseJob::start() {
  host_.reset();  // one process of the port at a time
  judged_by_host_.clear();
  has_failed_ = false;
  auto host = start_host(options_, {&case_, vehicle_model_.get()});
  if (!host) return tl::unexpected(host.error());
  host_ = *std::move(host);
  return {};
}

Result<void> CaseJob::open() {
  if (auto started = start(); !started) return started;
  auto golden = Golden::open(golden_root_, case_);
  if (!golden) return tl::unexpected(golden.error());
  golden_.emplace(*std::move(golden));
  return {};
}

void CaseJob::close() {
  host_.reset();
  golden_.reset();
}

Result<CaseResult> CaseJob::run(std::size_t task) {
  auto result = judged(task);
  if (result && fails_a_run(result->verdict) && !judged_by_host_.empty()) {
    result = repeated_alone(task, *std::move(result));
  }
  if (!result) return result;
  // After a timeout the host answers the other requests at once: the port is not started again.
  has_failed_ = fails_a_run(result->verdict) && result->verdict != Verdict::timeout;
  judged_by_host_.push_back(result->id());
  return result;
}

Result<CaseResult> CaseJob::repeated_alone(std::size_t task, CaseResult failed) {
  failed.after = judged_by_host_;
  if (failed.verdict == Verdict::timeout) return failed;
  if (auto started = start(); !started) return tl::unexpected(started.error());
  auto alone = judged(task);
  if (!alone || fails_a_run(alone->verdict)) return alone;
  failed.reason += fmt::format(
      "{}it passes alone, in a new process of the port: an earlier instance "
      "has left state behind",
      failed.reason.empty() ? "" : "; ");
  return failed;
}

Result<CaseResult> CaseJob::judged(std::size_t task) {
  const RunConfiguration& configuration = configurations_[task];
  if (!vehicle_model_)
    return evaluate_case(case_, configuration.rate.unit, *golden_, *host_, judge_);
  return evaluate_flight(case_, configuration, *vehicle_model_, *golden_, *host_,
                         judge_.save_traces);
}

Result<CaseResult> TimedJob::run(std::size_t) {
  const auto host = start_host(options_, {&case_, vehicle_model_.get()});
  if (!host) return tl::unexpected(host.error());
  return evaluate_timed_flight(case_, timing_.configuration, *vehicle_model_, timing_.ticks, **host,
                               saved_traces_);
}

Result<Jobs<CaseResult>> case_jobs(const std::vector<SelectedCase>& cases,
                                   const std::filesystem::path& golden_root,
                                   VehicleModels& vehicle_models, const JudgeOptions& judge,
                                   const HostOptions& options) {
  Jobs<CaseResult> jobs;
  for (const auto& [the_case, configurations] : cases) {
    for (auto begin = configurations.begin(); begin != configurations.end();) {
      const auto end =
          std::find_if(begin, configurations.end(), [&](const RunConfiguration& configuration) {
            return configuration.plant_configuration != begin->plant_configuration;
          });
      std::shared_ptr<const VehicleModel> vehicle_model;
      if (begin->plant_configuration) {
        auto loaded = vehicle_models.get(begin->plant_configuration->vehicle);
        if (!loaded) return tl::unexpected(loaded.error());
        vehicle_model = *loaded;
      }
      jobs.push_back(std::make_unique<CaseJob>(the_case, std::vector(begin, end), vehicle_model,
                                               golden_root, judge, options));
      begin = end;
    }
  }
  return jobs;
}

}  // namespace attest
