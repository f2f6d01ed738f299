#include "harness/verify/case_job.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/golden/make_golden.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {

std::string Codec<VectorResult>::encode(const Result<VectorResult>& result) {
  return attest::encode(result.map([](const VectorResult& one) { return to_json(one); }));
}

Result<VectorResult> Codec<VectorResult>::decode(const std::string& text) {
  return attest::decode(text).and_then(vector_result_from_json);
}

CaseJob::CaseJob(const std::vector<SelectedCase>& cases,
                 std::shared_ptr<const VehicleModel> vehicle_model,
                 std::shared_ptr<const Goldens> goldens, JudgeOptions judge, HostOptions options)
    : PortJob(std::move(options)),
      vehicle_model_(std::move(vehicle_model)),
      goldens_(std::move(goldens)),
      judge_(std::move(judge)) {
  for (const SelectedCase& selected : cases) {
    const auto the_case = std::make_shared<const Case>(selected.the_case);
    for (const RunConfiguration& configuration : selected.configurations) {
      vectors_.push_back({the_case, configuration});
    }
  }
}

Result<void> CaseJob::start() {
  host_.reset();  // one process of the port at a time
  judged_by_host_.clear();
  needs_new_process_ = false;
  auto host = start_host(options_, {vectors_.front().the_case.get(), vehicle_model_.get()});
  if (!host) return tl::unexpected(host.error());
  host_ = *std::move(host);
  return {};
}

Result<void> CaseJob::open() { return start(); }

void CaseJob::close() {
  host_.reset();
  golden_.reset();
  golden_of_.reset();
}

Result<VectorResult> CaseJob::run(std::size_t task) {
  const Vector& vector = vectors_[task];
  auto result = judged(vector);
  if (result && fails_a_run(result->verdict) && !judged_by_host_.empty() && is_repeated(*result)) {
    result = repeated_alone(vector, *std::move(result));
  }
  if (!result) return result;
  needs_new_process_ = must_start_again(task, *result);
  judged_by_host_.push_back(result->id());
  return result;
}

namespace {

// The port answered all requests, with wrong outputs.
bool has_wrong_outputs(const VectorResult& result) {
  return (result.verdict == Verdict::fail || result.verdict == Verdict::non_finite) && result.first;
}

}  // namespace

bool CaseJob::is_repeated(const VectorResult& failed) const {
  constexpr int enough = 3;
  const bool is_program = kind_of(options_.port).is_program;
  return !(is_program && failed_alone_ >= enough && has_wrong_outputs(failed));
}

bool CaseJob::must_start_again(std::size_t task, const VectorResult& result) const {
  if (host_->is_spent()) return true;
  if (contains(host_->declarations().lacks.features, Feature::instances)) return true;
  // A vector of a feature that the port lacks may have ended in a crash or a timeout. A flight of
  // one is not flown.
  const bool may_have_failed = !result.lacking.empty() && result.has_after_all.empty();
  if (may_have_failed && !result.plant_configuration) return true;
  // What an instance with wrong outputs left behind is not known. But if a vector fails later, it
  // is repeated in a new process.
  if (!fails_a_run(result.verdict) || has_wrong_outputs(result)) return false;
  // After a timeout the host answers the other requests at once: the port is not started again for
  // this case.
  const bool is_last_of_case =
      task + 1 < vectors_.size() && vectors_[task + 1].the_case != vectors_[task].the_case;
  return result.verdict != Verdict::timeout || is_last_of_case;
}

Result<VectorResult> CaseJob::repeated_alone(const Vector& vector, VectorResult failed) {
  failed.after = judged_by_host_;
  if (failed.verdict == Verdict::timeout) return failed;
  if (auto started = start(); !started) return tl::unexpected(started.error());
  auto alone = judged(vector);
  const bool fails_alone = !alone || fails_a_run(alone->verdict);
  failed_alone_ = fails_alone ? failed_alone_ + 1 : 0;
  if (fails_alone) return alone;
  failed.reason += fmt::format(
      "{}it passes alone, in a new process of the port: an earlier instance "
      "has left state behind",
      failed.reason.empty() ? "" : "; ");
  return failed;
}

Result<void> CaseJob::open_golden(const Vector& vector) {
  const bool is_made = judge_.by_reference && !goldens_->has(*vector.the_case);
  if (golden_of_ == vector.the_case && !is_made) return {};
  auto golden =
      is_made ? golden_by_reference(*vector.the_case, vector.configuration, vehicle_model_.get())
              : goldens_->open(*vector.the_case);
  if (!golden) return tl::unexpected(golden.error());
  golden_.emplace(*std::move(golden));
  golden_of_ = vector.the_case;
  golden_is_made_ = is_made;
  return {};
}

Result<VectorResult> CaseJob::judged(const Vector& vector) {
  if (auto opened = open_golden(vector); !opened) return tl::unexpected(opened.error());
  const Case& the_case = *vector.the_case;
  const RunConfiguration& configuration = vector.configuration;
  auto result =
      vehicle_model_
          ? evaluate_flight(the_case, configuration, *vehicle_model_, *golden_, *host_, judge_)
          : evaluate_case(the_case, configuration.rate.motor_unit, *golden_, *host_, judge_);
  if (!result) return result;
  result->no_golden = golden_is_made_ && is_judged(result->verdict);
  add_last_words(*host_, *result);
  return result;
}

Result<VectorResult> TimedJob::run(std::size_t) {
  const auto host = start_host(options_, {&case_, vehicle_model_.get()});
  if (!host) return tl::unexpected(host.error());
  return evaluate_timed_flight(case_, timing_.configuration, *vehicle_model_, timing_.ticks, **host,
                               judge_);
}

namespace {

using CasesOfJob = std::vector<SelectedCase>;

// A launch of a process costs more than the steps of a vector of one rate (`ci/bench`, "suite at
// 250 Hz"), and a program may need seconds to start.
constexpr std::size_t most_vectors = 48;
// A case with many rates has a process of its own, so that most cases meet a first instance.
constexpr std::size_t many_rates = 4;

const std::optional<PlantConfiguration>& plant_of(const SelectedCase& selected) {
  return selected.configurations.front().plant_configuration;
}

// The flights with each plant configuration as a case of their own.
std::vector<SelectedCase> split_by_plant(const std::vector<SelectedCase>& cases) {
  std::vector<SelectedCase> parts;
  for (const auto& [the_case, configurations] : cases) {
    for (auto begin = configurations.begin(); begin != configurations.end();) {
      const auto end =
          std::find_if(begin, configurations.end(), [&](const RunConfiguration& configuration) {
            return configuration.plant_configuration != begin->plant_configuration;
          });
      parts.push_back({the_case, {begin, end}});
      begin = end;
    }
  }
  return parts;
}

bool has_room_for(const SelectedCase& next, const CasesOfJob& job) {
  const auto is_alone = [](const SelectedCase& one) {
    return plant_of(one) || one.configurations.size() >= many_rates;
  };
  if (is_alone(next) || is_alone(job.front())) return false;
  std::size_t vectors = next.configurations.size();
  for (const SelectedCase& selected : job) vectors += selected.configurations.size();
  return vectors <= most_vectors && next.the_case.profile == job.front().the_case.profile;
}

std::vector<CasesOfJob> cases_of_jobs(const std::vector<SelectedCase>& cases) {
  std::vector<CasesOfJob> jobs;
  for (SelectedCase& next : split_by_plant(cases)) {
    if (jobs.empty() || !has_room_for(next, jobs.back())) jobs.emplace_back();
    jobs.back().push_back(std::move(next));
  }
  return jobs;
}

}  // namespace

Result<Jobs<VectorResult>> case_jobs(const std::vector<SelectedCase>& cases,
                                     std::shared_ptr<const Goldens> goldens,
                                     VehicleModels& vehicle_models, const JudgeOptions& judge,
                                     const HostOptions& options) {
  Jobs<VectorResult> jobs;
  // Read here, so that the workers have them.
  for (const SelectedCase& selected : cases) goldens->origins_of(selected.the_case.profile);
  for (const CasesOfJob& of_job : cases_of_jobs(cases)) {
    std::shared_ptr<const VehicleModel> vehicle_model;
    if (const auto& plant = plant_of(of_job.front())) {
      auto loaded = vehicle_models.get(plant->vehicle);
      if (!loaded) return tl::unexpected(loaded.error());
      vehicle_model = *loaded;
    }
    jobs.push_back(std::make_unique<CaseJob>(of_job, vehicle_model, goldens, judge, options));
  }
  return jobs;
}

}  // namespace attest
