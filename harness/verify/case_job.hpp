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
struct Codec<VectorResult> {
  static std::string encode(const Result<VectorResult>& result);
  static Result<VectorResult> decode(const std::string& text);
};

// Judges vectors in one process of the port. Those of flights are all of one case, with the same
// vehicle and plant.
//
// A failure after other vectors is repeated in a new process, and the result is that of the
// repetition. If the vector passes there, the failure stays, and VectorResult::after names the
// others. So each failure can be reproduced. A timeout is not repeated; the other vectors of its
// case time out too. After a failure other than wrong outputs the next vector has a new process.
// A program may need seconds to start: after three repetitions in a row that failed too, failures
// of a program by wrong outputs are not repeated.
class CaseJob final : public PortJob<VectorResult> {
 public:
  // `vehicle_model` is that of the flights' vehicle; null for open loop.
  CaseJob(const std::vector<SelectedCase>& cases, std::shared_ptr<const VehicleModel> vehicle_model,
          std::shared_ptr<const Goldens> goldens, JudgeOptions judge, HostOptions options);

  std::size_t size() const override { return vectors_.size(); }
  Result<void> open() override;
  Result<VectorResult> run(std::size_t task) override;
  bool is_spent() const override { return !host_ || host_->is_spent() || needs_new_process_; }
  void close() override;

 private:
  struct Vector {
    std::shared_ptr<const Case> the_case;
    RunConfiguration configuration;
  };

  Result<void> start();
  Result<void> open_golden(const Vector& vector);
  Result<VectorResult> judged(const Vector& vector);
  bool is_repeated(const VectorResult& failed) const;
  Result<VectorResult> repeated_alone(const Vector& vector, VectorResult failed);
  bool must_start_again(std::size_t task, const VectorResult& result) const;

  std::vector<Vector> vectors_;
  std::shared_ptr<const VehicleModel> vehicle_model_;
  std::shared_ptr<const Goldens> goldens_;
  JudgeOptions judge_;
  std::unique_ptr<PortHost> host_;
  std::vector<std::string> judged_by_host_;  // ids of vectors
  bool needs_new_process_ = false;           // for the next vector
  int failed_alone_ = 0;                     // repetitions in a row that failed too
  std::shared_ptr<const Case> golden_of_;
  std::optional<Golden> golden_;
  bool golden_is_made_ = false;  // for the vector, by the reference
};

// Judges a flight at recorded times.
class TimedJob final : public PortJob<VectorResult> {
 public:
  TimedJob(Case the_case, TimingFile timing, std::shared_ptr<const VehicleModel> vehicle_model,
           JudgeOptions judge, HostOptions options)
      : PortJob(std::move(options)),
        case_(std::move(the_case)),
        timing_(std::move(timing)),
        vehicle_model_(std::move(vehicle_model)),
        judge_(std::move(judge)) {}

  std::size_t size() const override { return 1; }
  Result<VectorResult> run(std::size_t task) override;

 private:
  Case case_;
  TimingFile timing_;
  std::shared_ptr<const VehicleModel> vehicle_model_;
  JudgeOptions judge_;
};

// The jobs of the selected cases, in the order of the cases. An open-loop case is one job, or
// several cases of one group are if together they have only few vectors; of a program, several
// cases of one profile, because it may need seconds to start. A flight is one job for
// each plant configuration, so that several workers fly it at the same time. Errors: a vehicle
// cannot be loaded.
Result<Jobs<VectorResult>> case_jobs(const std::vector<SelectedCase>& cases,
                                     std::shared_ptr<const Goldens> goldens,
                                     VehicleModels& vehicle_models, const JudgeOptions& judge,
                                     const HostOptions& options);

}  // namespace attest
