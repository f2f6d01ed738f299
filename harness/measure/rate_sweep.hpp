// The limits of a vehicle: the lowest loop rate and the largest delay with which a port still flies
// a case within the bounds of its metrics.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/host/port_process.hpp"
#include "harness/verify/port_job.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// A flight of the search that the port flew to its end, or until it lost the vehicle.
struct RateSweepTrial {
  double rate_hz = 0, delay_ms = 0;
  std::vector<double>
      values;          // of the metrics, in the order of the case; empty: the vehicle is lost
  bool holds = false;  // all metrics are within their bounds
};

// One of the two figures is set. It is below 0 if no value holds, or if `result` is not a pass.
struct RateSweepResult {
  CaseResult result;  // a verdict other than pass: the port failed
  std::optional<double> lowest_rate_hz;
  std::optional<double> largest_delay_ms;   // of the motor commands, beyond the case's own
  std::vector<RateSweepTrial> trials = {};  // in the order of the search
};

template <>
struct Codec<RateSweepResult> {
  static std::string encode(const Result<RateSweepResult>& result);
  static Result<RateSweepResult> decode(const std::string& text);
};

// The searches for one vehicle on one plant. Task 0 searches for the lowest rate. In the cascade
// this is the rate of the rate unit; the attitude unit has its usual rate, or that of the rate unit
// if that is lower. Task i searches for the largest delay at `rates[i - 1]`. Each search begins at
// 1000 Hz, or without delay, and moves in steps until a flight misses a bound. Then it bisects the
// last step. It does not try rates below, or delays above, that of the first flight that missed a
// bound.
class RateSweepJob final : public PortJob<RateSweepResult> {
 public:
  RateSweepJob(Case the_case, PlantConfiguration plant_configuration, std::vector<LoopRate> rates,
               std::shared_ptr<const VehicleModel> vehicle_model, HostOptions options)
      : case_(std::move(the_case)),
        plant_configuration_(std::move(plant_configuration)),
        rates_(std::move(rates)),
        vehicle_model_(std::move(vehicle_model)),
        options_(std::move(options)) {}

  std::size_t size() const override { return rates_.size() + 1; }
  Result<void> open() override;
  Result<RateSweepResult> run(std::size_t task) override;
  bool is_spent() const override { return host_->is_spent(); }
  void close() override { host_.reset(); }

 private:
  Case case_;
  PlantConfiguration plant_configuration_;
  std::vector<LoopRate> rates_;
  std::shared_ptr<const VehicleModel> vehicle_model_;
  HostOptions options_;
  std::unique_ptr<PortHost> host_;
};

}  // namespace attest
