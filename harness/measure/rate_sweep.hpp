// Searches for the lowest loop rate and the largest delay with which a port still flies a vehicle
// within the bounds of a case's metrics.
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

// A flight of the search, which ended as planned or with the loss of the vehicle.
struct RateSweepTrial {
  double rate_hz = 0, delay_ms = 0;
  std::vector<double>
      values;          // of the metrics, in the order of the case; empty: the vehicle is lost
  bool holds = false;  // all metrics are within their bounds
};

// Either `lowest_rate_hz` or `largest_delay_ms` is set. It is below 0 if the first flight of the
// search does not hold, or if the verdict is not pass.
struct RateSweepResult {
  VectorResult result;  // pass, or the verdict on a port that did not fly all flights
  std::optional<double> lowest_rate_hz;
  std::optional<double> largest_delay_ms;   // of the motor commands, beyond the case's own
  std::vector<RateSweepTrial> trials = {};  // in the order of the search
};

template <>
struct Codec<RateSweepResult> {
  static std::string encode(const Result<RateSweepResult>& result);
  static Result<RateSweepResult> decode(const std::string& text);
};

// The searches for one vehicle on one plant. Task 0 searches for the lowest rate, from 1000 Hz down
// to 2 Hz. In the cascade this is the rate of the rate unit; the attitude unit has the rate that it
// has in `rates[0]`, or that of the rate unit if this is lower. Task i searches for the largest
// delay at `rates[i - 1]`, from 0 up to half a second. Each search moves in steps until a flight
// misses a bound or loses the vehicle. Then it bisects the last step. It does not go beyond that
// flight, so a lower rate or a larger delay may hold again.
class RateSweepJob final : public PortJob<RateSweepResult> {
 public:
  // REQUIRES: `rates` is not empty.
  RateSweepJob(Case the_case, PlantConfiguration plant_configuration, std::vector<LoopRate> rates,
               std::shared_ptr<const VehicleModel> vehicle_model, HostOptions options)
      : PortJob(std::move(options)),
        case_(std::move(the_case)),
        plant_configuration_(std::move(plant_configuration)),
        rates_(std::move(rates)),
        vehicle_model_(std::move(vehicle_model)) {}

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
  std::unique_ptr<PortHost> host_;
};

}  // namespace attest
