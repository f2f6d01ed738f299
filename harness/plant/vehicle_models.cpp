#include "harness/plant/vehicle_models.hpp"

namespace attest {

Result<std::shared_ptr<const VehicleModel>> VehicleModels::get(const std::string& name) {
  const auto known = loaded_.find(name);
  if (known != loaded_.end()) return known->second;
  auto loaded = VehicleModel::load(models_, name);
  if (loaded) loaded_[name] = *loaded;
  return loaded;
}

}  // namespace attest
