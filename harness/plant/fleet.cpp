#include "harness/plant/fleet.hpp"

namespace attest {

Result<std::shared_ptr<const Airframe>> Fleet::get(const std::string& name) {
  const auto known = loaded_.find(name);
  if (known != loaded_.end()) return known->second;
  auto loaded = Airframe::load(models_, name);
  if (loaded) loaded_[name] = *loaded;
  return loaded;
}

}  // namespace attest
