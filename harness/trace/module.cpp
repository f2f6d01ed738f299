#include "harness/trace/module.hpp"

#include <algorithm>
#include <cstring>

#include "harness/trace/module_table.hpp"

namespace attest {
namespace {

// In Sample, all outputs follow all inputs, so the outputs of all modules are one range of bytes.
constexpr std::size_t outputs_begin = sizeof(Sample) - outputs_size;

}  // namespace

std::span<const std::byte> Sample::outputs() const {
  return std::as_bytes(std::span(this, 1)).subspan(outputs_begin);
}

std::span<std::byte> Sample::outputs() {
  return std::as_writable_bytes(std::span(this, 1)).subspan(outputs_begin);
}

void Sample::clear_outputs() { std::memset(outputs().data(), 0, outputs().size()); }

void Sample::copy_outputs(const Sample& from) {
  std::memcpy(outputs().data(), from.outputs().data(), outputs().size());
}

std::vector<std::byte> Block::copy(std::span<const Sample> samples) const {
  std::vector<std::byte> copied(samples.size() * size);
  std::byte* to = copied.data();
  for (const Sample& sample : samples) {
    std::memcpy(to, in(sample), size);
    to += size;
  }
  return copied;
}

void Block::paste(std::span<const std::byte> copied, std::span<Sample> samples) const {
  const std::byte* from = copied.data();
  for (Sample& sample : samples) {
    std::memcpy(in(sample), from, size);
    from += size;
  }
}

std::span<const ModuleInfo> modules() { return module_table; }

const ModuleInfo& info_of(Module module) { return module_table[static_cast<std::size_t>(module)]; }

std::string_view name_of(Module module) { return info_of(module).name; }

std::optional<Module> module_named(std::string_view name) {
  const auto found = std::find_if(module_table.begin(), module_table.end(),
                                  [&](const ModuleInfo& info) { return info.name == name; });
  return found == module_table.end() ? std::nullopt : std::optional(found->module);
}

std::vector<std::string_view> names_of(const ModuleSet& modules) {
  std::vector<std::string_view> names;
  for (const ModuleInfo& info : module_table) {
    if (contains(modules, info.module)) names.push_back(info.name);
  }
  return names;
}

}  // namespace attest
