// The vehicles of a suite, each loaded once, when it is first asked for.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "harness/plant/plant.hpp"

namespace attest {

class Fleet {
 public:
  explicit Fleet(std::filesystem::path models) : models_(std::move(models)) {}

  // Errors: as of Airframe::load.
  Result<std::shared_ptr<const Airframe>> get(const std::string& name);

 private:
  std::filesystem::path models_;
  std::map<std::string, std::shared_ptr<const Airframe>> loaded_;
};

}  // namespace attest
