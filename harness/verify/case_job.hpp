// The cases of a run as jobs for worker processes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/casefile/select.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/golden/golden.hpp"
#include "harness/host/port_process.hpp"
#include "harness/loop/timing_file.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/port_job.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

template <>
struct Codec<CaseResult> {
  static std::string encode(const Result<CaseResult>& result);
  static Result<CaseResult> decode(const std::string& text);
};

// Judges a case in several of its run configurations, in one process of the port. Those of a flight
// all have the same vehicle and plant.
//
// A failure after other vectors is repeated in a new process, and the result is that of the
// repetition. If the vector passes there, the failure stays, and CaseResult::after names the
// others. So each failure can be reproduced. A timeout is not repeated. After any other failure the
// next vector has a new process.
class CaseJob final : public PortJob<CaseResult> {
 public:
  // `vehicle_model` is that of a flight's vehicle; null for open loop.
  CaseJob(Case the_case, std::vector<RunConfiguration> configurations,
          std::shared_ptr<const VehicleModel> vehicle_model, std::filesystem::path golden_root,
          JudgeOptions judge, HostOptions options)
      : PortJob(std::move(options)),
        case_(std::move(the_case)),
        configurations_(std::move(configurations)),
        vehicle_model_(std::move(vehicle_model)),
        golden_root_(std::move(golden_root)),
        judge_(std::move(judge)) {}

  std::size_t size() const override { return configurations_.size(); }
  Result<void> open() override;
  Result<CaseResult> run(std::size_t task) override;
  bool is_spent() const override { return !host_ || host_->is_spent() || has_failed_; }
  void close() override;

 private:
  Result<void> start();
  Result<CaseResult> judged(std::size_t task);
  Result<CaseResult> repeated_alone(std::size_t task, CaseResult failed);

  Case case_;
  std::vector<RunConfiguration> configurations_;
  std::shared_ptr<const VehicleModel> vehicle_model_;
  std::filesystem::path golden_root_;
  JudgeOptions judge_;
  std::unique_ptr<PortHost> host_;
  std::vector<std::string> judged_by_host_;  // ids of vectors
  bool has_failed_ = false;                  // a vector, not by a timeout
  std::optional<Golden> golden_;
};

// Judges a flight at recorded times.
class TimedJob final : public PortJob<CaseResult> {
 public:
  TimedJob(Case the_case, TimingFile timing, std::shared_ptr<const VehicleModel> vehicle_model,
           std::filesystem::path saved_traces, HostOptions options)
      : PortJob(std::move(options)),
        case_(std::move(the_case)),
        timing_(std::move(timing)),
        vehicle_model_(std::move(vehicle_model)),
        saved_traces_(std::move(saved_traces)) {}

  std::size_t size() const override { return 1; }
  Result<CaseResult> run(std::size_t task) override;

 private:
  Case case_;
  TimingFile timing_;
  std::shared_ptr<const VehicleModel> vehicle_model_;
  std::filesystem::path saved_traces_;
};

// The jobs of the selected cases, in the order of the cases. An open-loop case is one job. A flight
// is one job for each plant configuration, so that several workers fly it at the same time. Errors:
// a vehicle cannot be loaded.
Result<Jobs<CaseResult>> case_jobs(const std::vector<SelectedCase>& cases,
                                   const std::filesystem::path& golden_root,
                                   VehicleModels& vehicle_models, const JudgeOptions& judge,
                                   const HostOptions& options);

}  // namespace attest
