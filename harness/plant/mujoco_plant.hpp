// The plant in MuJoCo: a free body with one actuator per rotor, integrated by the Runge-Kutta
// method of order 4 at the physics rate. Only the code of this plant uses FLU and ENU.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "harness/core/result.hpp"
#include "harness/plant/plant.hpp"

namespace attest {

// A compiled MuJoCo model. Immutable; any number of plants may use it.
class MujocoModel {
 public:
  // `text` is that of the file `xml`; files that it includes are read from disk. Errors: XML that
  // MuJoCo refuses, with its line; the errors of numbers_of(); a model that disagrees with the
  // vehicle's TOML, with the quantity and both values.
  static Result<std::shared_ptr<const MujocoModel>> parse(std::string_view text,
                                                          const std::filesystem::path& xml,
                                                          const Vehicle& vehicle);
  virtual ~MujocoModel() = default;

  // A copy with the numbers of another vehicle. Errors: another number of rotors; those of MuJoCo.
  virtual Result<std::shared_ptr<const MujocoModel>> with_numbers_of(
      const Vehicle& vehicle) const = 0;

  // Errors: the text of MuJoCo's error. The vehicle must outlive the plant.
  virtual Result<std::unique_ptr<Plant>> make_plant(const Vehicle& vehicle,
                                                    const PlantOptions& options) const = 0;
};

}  // namespace attest
