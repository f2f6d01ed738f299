// A MuJoCo model with arrays of its own, which may be changed. The textures are left out: only a
// viewer reads them, and they are 98% of the bytes of a vehicle's model.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

struct mjModel_;

namespace attest {

class MujocoModelCopy {
 public:
  explicit MujocoModelCopy(const mjModel_& original);
  MujocoModelCopy(const MujocoModelCopy&) = delete;
  MujocoModelCopy& operator=(const MujocoModelCopy&) = delete;
  ~MujocoModelCopy();

  mjModel_& model() { return *model_; }
  const mjModel_& model() const { return *model_; }

 private:
  std::unique_ptr<mjModel_> model_;
  std::vector<std::byte> memory_;  // of all arrays
};

}  // namespace attest
