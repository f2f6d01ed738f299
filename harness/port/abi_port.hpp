// A port with the C ABI of attest_unit.h. Its table may be linked in or loaded from a library.
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
  // `self`: the unit that the table made. `timestamp_sample` is null if the unit does not need the
  // time of the sample.
  AbiUnit(const ModuleAbi& abi, const void* table, void* self,
          const attest_timestamp_sample* timestamp_sample, const Lacks& lacks)
      : abi_(abi), table_(table), self_(self), timestamp_sample_(timestamp_sample), lacks_(lacks) {}
  ~AbiUnit() override { abi_.destroy(table_, self_); }
  AbiUnit(const AbiUnit&) = delete;
  AbiUnit& operator=(const AbiUnit&) = delete;

  int set_parameter(const std::string& name, float value) override {
    const auto ask = [&] { return abi_.set_parameter(table_, self_, name.c_str(), value); };
    const auto* const constant = lacks_.constant(name);
    return constant ? constant->answer_to(value, ask) : ask();
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    if (timestamp_sample_ == nullptr) return ATTEST_OK;
    return timestamp_sample_->set_timestamp_sample(self_, timestamp_sample_us);
  }
  int step_structs(const void* in, void* out) override { return abi_.step(table_, self_, in, out); }

 private:
  const ModuleAbi& abi_;
  const void* table_;
  void* self_;
  const attest_timestamp_sample* timestamp_sample_;
  const Lacks lacks_;  // a copy: the unit may outlive the port
};

// The words of a list that a port declares as text: "sticks, acro".
inline std::vector<std::string> words_of_list(const char* list) {
  std::vector<std::string> words;
  std::istringstream text(list ? list : "");
  for (std::string word; std::getline(text >> std::ws, word, ',');) {
    word.erase(word.find_last_not_of(" \t\r\n") + 1);
    words.push_back(word);
  }
  return words;
}

// `owner` keeps the memory of the table alive, for example a loaded library.
class AbiPort final : public Port {
 public:
  explicit AbiPort(const attest_unit& table, std::shared_ptr<void> owner = nullptr)
      : owner_(std::move(owner)), table_(table), lacks_(declared_lacks().value_or(Lacks())) {}

  std::string name() const override { return table_.name; }
  std::string version() const override { return table_.version; }
  std::vector<std::string> unsupported_groups() const override {
    return words_of_list(extension<char>(ATTEST_EXTENSION_UNSUPPORTED_GROUPS));
  }
  // Errors: those of Lacks::parse(). lacks() is then empty.
  Result<Lacks> declared_lacks() const {
    return Lacks::parse(words_of_list(extension<char>(ATTEST_EXTENSION_LACKS)));
  }
  const Lacks& lacks() const override { return lacks_; }
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
    const ModuleInfo& info = info_of(module);
    const bool is_controller = info.extension == nullptr;
    const void* const table = is_controller ? &table_ : extension<void>(info.extension);
    void* const self = info.abi.create(table, profile.c_str(), definition.c_str());
    if (self == nullptr) return nullptr;
    const auto* times = is_controller
                            ? extension<attest_timestamp_sample>(ATTEST_EXTENSION_TIMESTAMP_SAMPLE)
                            : nullptr;
    return std::make_unique<AbiUnit>(info.abi, table, self, times, lacks_);
  }

 private:
  template <typename Interface>
  const Interface* extension(const char* id) const {
    return table_.extension ? static_cast<const Interface*>(table_.extension(id)) : nullptr;
  }

  std::shared_ptr<void> owner_;
  const attest_unit& table_;
  Lacks lacks_;
};

}  // namespace attest
