// A port behind the C ABI of attest_unit.h, wherever its table came from.
#pragma once

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "harness/port/port.hpp"

namespace attest {

class AbiUnit final : public Unit {
 public:
  AbiUnit(const attest_unit& table, void* self) : table_(table), self_(self) {}
  ~AbiUnit() override { table_.destroy(self_); }
  AbiUnit(const AbiUnit&) = delete;
  AbiUnit& operator=(const AbiUnit&) = delete;

  int set_parameter(const std::string& name, float value) override {
    return table_.set_parameter(self_, name.c_str(), value);
  }
  int step(const attest_inputs& in, attest_outputs& out) override {
    return table_.step(self_, &in, &out);
  }

 private:
  const attest_unit& table_;
  void* self_;
};

// `owner` keeps what the table lives in (a loaded library) alive.
class AbiPort final : public Port {
 public:
  explicit AbiPort(const attest_unit& table, std::shared_ptr<void> owner = nullptr)
      : owner_(std::move(owner)), table_(table) {}

  std::string name() const override { return table_.name; }
  std::string version() const override { return table_.version; }
  std::vector<std::string> unsupported_groups() const override {
    const void* list =
        table_.extension ? table_.extension(ATTEST_EXTENSION_UNSUPPORTED_GROUPS) : nullptr;
    std::vector<std::string> groups;
    std::istringstream names(list ? static_cast<const char*>(list) : "");
    for (std::string name; std::getline(names, name, ',');) groups.push_back(name);
    return groups;
  }
  std::unique_ptr<Unit> create(const std::string& profile) override {
    void* self = table_.create(profile.c_str());
    return self ? std::make_unique<AbiUnit>(table_, self) : nullptr;
  }

 private:
  std::shared_ptr<void> owner_;
  const attest_unit& table_;
};

}  // namespace attest
