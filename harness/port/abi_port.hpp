// A port with the C ABI of attest_unit.h. Its table may be linked in or loaded from a library.
#pragma once

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "harness/port/port.hpp"

namespace attest {

// Only for decltype: UnitOf with the types of the parameters of a table's step().
template <typename In, typename Out>
UnitOf<In, Out> unit_with(int (*)(void*, const In*, Out*));

// Table is attest_unit or the table of an extension.
template <typename Table>
class AbiUnit final : public decltype(unit_with(Table::step)) {
 public:
  using Base = decltype(unit_with(Table::step));
  using typename Base::Inputs;
  using typename Base::Outputs;

  // `timestamp_sample` is null if the unit does not need the time of the sample.
  AbiUnit(const Table& table, void* self, const attest_timestamp_sample* timestamp_sample)
      : table_(table), self_(self), timestamp_sample_(timestamp_sample) {}
  ~AbiUnit() override { table_.destroy(self_); }
  AbiUnit(const AbiUnit&) = delete;
  AbiUnit& operator=(const AbiUnit&) = delete;

  int set_parameter(const std::string& name, float value) override {
    if constexpr (requires { table_.set_parameter; }) {
      return table_.set_parameter(self_, name.c_str(), value);
    }
    return ATTEST_INVALID;
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    if (timestamp_sample_ == nullptr) return ATTEST_OK;
    return timestamp_sample_->set_timestamp_sample(self_, timestamp_sample_us);
  }
  int step(const Inputs& in, Outputs& out) override { return table_.step(self_, &in, &out); }

 private:
  const Table& table_;
  void* self_;
  const attest_timestamp_sample* timestamp_sample_;
};

// `owner` keeps the memory of the table alive, for example a loaded library.
class AbiPort final : public Port {
 public:
  explicit AbiPort(const attest_unit& table, std::shared_ptr<void> owner = nullptr)
      : owner_(std::move(owner)), table_(table) {}

  std::string name() const override { return table_.name; }
  std::string version() const override { return table_.version; }
  std::vector<std::string> unsupported_groups() const override {
    const auto* list = extension<char>(ATTEST_EXTENSION_UNSUPPORTED_GROUPS);
    std::vector<std::string> groups;
    std::istringstream names(list ? list : "");
    for (std::string name; std::getline(names >> std::ws, name, ',');) {
      name.erase(name.find_last_not_of(" \t\r\n") + 1);
      groups.push_back(name);
    }
    return groups;
  }
  std::optional<int> fraction_bits() const override {
    const auto* arithmetic = extension<char>(ATTEST_EXTENSION_ARITHMETIC);
    if (arithmetic == nullptr) return std::nullopt;
    const auto bits = parse_fraction_bits(arithmetic);
    return bits ? std::optional(*bits) : std::nullopt;
  }
  std::optional<Rate> fixed_step() const override {
    const auto* hertz = extension<char>(ATTEST_EXTENSION_FIXED_STEP);
    if (hertz == nullptr) return std::nullopt;
    const auto rate = Rate::parse(hertz);
    return rate ? std::optional(*rate) : std::nullopt;
  }
  ModuleSet modules() const override {
    ModuleSet set;
    for (const ModuleInfo& info : attest::modules()) {
      const bool has =
          info.extension ? extension<void>(info.extension) != nullptr : table_.create != nullptr;
      if (has) set |= only(info.module);
    }
    return set;
  }
  std::unique_ptr<Unit> create_unit(Module module, const std::string& profile,
                                    const std::string& definition) override {
    const char* const id = info_of(module).extension;
    switch (module) {
      case Module::mc_att_control:
        return wrapped(table_, table_.create(profile.c_str()),
                       extension<attest_timestamp_sample>(ATTEST_EXTENSION_TIMESTAMP_SAMPLE));
      case Module::mixer: {
        const auto& table = *extension<attest_mixer>(id);
        return wrapped(table, table.create(profile.c_str(), definition.c_str()));
      }
      case Module::battery_status: {
        const auto& table = *extension<attest_battery_status>(id);
        return wrapped(table, table.create(profile.c_str()));
      }
      case Module::attitude_unit: {
        const auto& table = *extension<attest_attitude_unit>(id);
        return wrapped(table, table.create(profile.c_str()));
      }
      case Module::rate_unit: {
        const auto& table = *extension<attest_rate_unit>(id);
        return wrapped(table, table.create(profile.c_str()));
      }
    }
    return nullptr;
  }

 private:
  template <typename Interface>
  const Interface* extension(const char* id) const {
    return table_.extension ? static_cast<const Interface*>(table_.extension(id)) : nullptr;
  }

  template <typename Table>
  static std::unique_ptr<Unit> wrapped(const Table& table, void* self,
                                       const attest_timestamp_sample* timestamp_sample = nullptr) {
    return self ? std::make_unique<AbiUnit<Table>>(table, self, timestamp_sample) : nullptr;
  }

  std::shared_ptr<void> owner_;
  const attest_unit& table_;
};

}  // namespace attest
