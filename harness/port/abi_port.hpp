// A port with the C ABI of attest_unit.h. Its table may be linked in or loaded from a library.
#pragma once

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "harness/port/port.hpp"

namespace attest {

// Table is attest_unit, attest_mixer or attest_battery_status.
template <typename Table, typename Interface>
class AbiUnit : public Interface {
 public:
  using typename Interface::Inputs;
  using typename Interface::Outputs;

  AbiUnit(const Table& table, void* self) : table_(table), self_(self) {}
  ~AbiUnit() override { table_.destroy(self_); }
  AbiUnit(const AbiUnit&) = delete;
  AbiUnit& operator=(const AbiUnit&) = delete;

  int set_parameter(const std::string& name, float value) override {
    if constexpr (requires { table_.set_parameter; }) {
      return table_.set_parameter(self_, name.c_str(), value);
    }
    return ATTEST_INVALID;
  }
  int step(const Inputs& in, Outputs& out) override { return table_.step(self_, &in, &out); }

 protected:
  const Table& table_;
  void* self_;
};

// The controller. `timestamp_sample` is null if it does not need the time of the sample.
class AbiController final : public AbiUnit<attest_unit, Unit> {
 public:
  AbiController(const attest_unit& table, const attest_timestamp_sample* timestamp_sample,
                void* self)
      : AbiUnit(table, self), timestamp_sample_(timestamp_sample) {}

  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    if (timestamp_sample_ == nullptr) return ATTEST_OK;
    return timestamp_sample_->set_timestamp_sample(self_, timestamp_sample_us);
  }

 private:
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
  std::unique_ptr<Unit> create(const std::string& profile) override {
    void* const self = table_.create(profile.c_str());
    if (self == nullptr) return nullptr;
    const auto* times = extension<attest_timestamp_sample>(ATTEST_EXTENSION_TIMESTAMP_SAMPLE);
    return std::make_unique<AbiController>(table_, times, self);
  }
  bool has_mixer() const override { return mixer() != nullptr; }
  bool has_battery_status() const override { return battery_status() != nullptr; }
  std::unique_ptr<MixerUnit> create_mixer(const std::string& profile,
                                          const std::string& definition) override {
    const attest_mixer& table = *mixer();
    return wrapped<MixerUnit>(table, table.create(profile.c_str(), definition.c_str()));
  }
  std::unique_ptr<BatteryUnit> create_battery_status(const std::string& profile) override {
    const attest_battery_status& table = *battery_status();
    return wrapped<BatteryUnit>(table, table.create(profile.c_str()));
  }

 private:
  template <typename Interface>
  const Interface* extension(const char* id) const {
    return table_.extension ? static_cast<const Interface*>(table_.extension(id)) : nullptr;
  }
  const attest_mixer* mixer() const { return extension<attest_mixer>(ATTEST_EXTENSION_MIXER); }
  const attest_battery_status* battery_status() const {
    return extension<attest_battery_status>(ATTEST_EXTENSION_BATTERY_STATUS);
  }

  template <typename Interface, typename Table>
  static std::unique_ptr<Interface> wrapped(const Table& table, void* self) {
    return self ? std::make_unique<AbiUnit<Table, Interface>>(table, self) : nullptr;
  }

  std::shared_ptr<void> owner_;
  const attest_unit& table_;
};

}  // namespace attest
