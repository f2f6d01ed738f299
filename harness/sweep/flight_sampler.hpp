// Makes the samples of a sweep: the same flight with other numbers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/toml_document.hpp"
#include "harness/plant/plant.hpp"
#include "harness/sweep/sweep_file.hpp"

namespace attest {

// The flight without dispersions.
struct NominalFlight {
  Case the_case;
  std::string case_text;
  PlantConfiguration plant_configuration;
  std::shared_ptr<const VehicleModel> vehicle_model;
  std::string vehicle_text;
};

// A flight whose case file and vehicle file have the numbers of one sample.
struct SampledFlight {
  std::uint64_t index = 0;
  std::vector<double> drawn;  // the number of each dispersion, in the order of the file
  std::string case_text;
  std::string vehicle_text;
  Case the_case;
  std::shared_ptr<const VehicleModel> vehicle_model;
};

class FlightSampler {
 public:
  // Also checks that case and vehicle accept the lowest and the highest number of each distribution
  // (the quantiles of 2^-53 and 1 - 2^-53) while the other numbers are at their medians. Errors,
  // with the line of the sweep file: those of bind_sweep(); a number that case or vehicle refuses.
  static Result<FlightSampler> make(SweepFile sweep, NominalFlight nominal);

  const SweepFile& sweep() const { return sweep_; }
  const NominalFlight& nominal() const { return nominal_; }
  // SHA-256 of all that the samples depend on (sweep file, case, plant, vehicle, MJCF and number of
  // samples). Samples with the same index and the same hash are the same.
  const std::string& sha256() const { return sha256_; }

  // Errors: case or vehicle refuses the numbers. The message names the sample and the numbers.
  Result<SampledFlight> sample(std::uint64_t index) const;

 private:
  FlightSampler(SweepFile sweep, NominalFlight nominal, TomlDocument case_document,
                TomlDocument vehicle_document);

  std::vector<double> drawn(std::uint64_t index) const;
  Result<void> check_ends() const;
  Result<void> apply(const std::string& what, SampledFlight& flight) const;
  Error refused(const std::string& what, DispersedKey::Document document, const std::string& text,
                const std::vector<double>& drawn, const Error& error) const;

  SweepFile sweep_;
  NominalFlight nominal_;
  TomlDocument case_document_, vehicle_document_;
  std::string sha256_;
  SampleStream stream_;
  std::shared_ptr<const DesignPoints> points_;
};

}  // namespace attest
