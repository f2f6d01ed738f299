// The vehicles of a suite. Each is loaded once, at its first use.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "harness/plant/plant.hpp"

namespace attest {

class VehicleModels {
 public:
  explicit VehicleModels(std::filesystem::path models) : models_(std::move(models)) {}

  // Errors: those of VehicleModel::load.
  Result<std::shared_ptr<const VehicleModel>> get(const std::string& name);

 private:
  std::filesystem::path models_;
  std::map<std::string, std::shared_ptr<const VehicleModel>> loaded_;
};

}  // namespace attest
