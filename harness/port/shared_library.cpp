// `lib:PATH`: a shared library that exports attest_unit_v1().
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "harness/core/dynamic_library.hpp"
#include "harness/port/abi_port.hpp"
#include "harness/port/port.hpp"

namespace attest {
namespace {

constexpr const char* symbol_name = "attest_unit_v1";

// A port that has no controller sets none of the controller's functions.
bool has_controller(const attest_unit& unit) {
  return unit.create || unit.destroy || unit.set_parameter || unit.step;
}

std::string missing_member(const attest_unit& unit) {
  if (!unit.name) return "name";
  if (!unit.version) return "version";
  if (!has_controller(unit)) return unit.extension ? "" : "create";
  if (!unit.create) return "create";
  if (!unit.destroy) return "destroy";
  if (!unit.set_parameter) return "set_parameter";
  if (!unit.step) return "step";
  return "";
}

// Checks the extensions that the port has: tables must be complete, texts must be valid.
Result<void> check_extensions(const attest_unit& unit, const std::string& path) {
  const auto incomplete = [&](const char* id) {
    return fail_at(path,
                   fmt::format("a member of its extension {} is NULL; every one must be set", id));
  };
  if (!unit.extension) return {};
  for (const ModuleInfo& info : modules()) {
    const void* const table = info.extension ? unit.extension(info.extension) : nullptr;
    if (table && !info.abi.is_complete(table)) return incomplete(info.extension);
  }
  const auto* times = static_cast<const attest_timestamp_sample*>(
      unit.extension(ATTEST_EXTENSION_TIMESTAMP_SAMPLE));
  if (times && !times->set_timestamp_sample) {
    return incomplete(ATTEST_EXTENSION_TIMESTAMP_SAMPLE);
  }
  if (const void* arithmetic = unit.extension(ATTEST_EXTENSION_ARITHMETIC)) {
    const auto bits = parse_fraction_bits(static_cast<const char*>(arithmetic));
    if (!bits) return fail_at(path, bits.error().message);
  }
  if (const void* hertz = unit.extension(ATTEST_EXTENSION_FIXED_STEP)) {
    const auto rate = Rate::parse(static_cast<const char*>(hertz));
    if (!rate) return fail_at(path, "its fixed step: " + rate.error().message);
  }
  return {};
}

Result<void> check_table(const attest_unit* unit, const std::string& path) {
  if (!unit) return fail_at(path, fmt::format("{}() returned NULL; return the table", symbol_name));
  if (unit->abi_version != ATTEST_UNIT_ABI_VERSION) {
    return fail_at(path, fmt::format("its ABI version is {}, this attest speaks {}; rebuild the "
                                     "port with the attest_unit.h of this attest",
                                     unit->abi_version, ATTEST_UNIT_ABI_VERSION));
  }
  if (const std::string name = missing_member(*unit); !name.empty()) {
    return fail_at(path, fmt::format("attest_unit.{} is NULL; only `extension` may be NULL, or all "
                                     "functions of the controller if the port has none",
                                     name));
  }
  return check_extensions(*unit, path);
}

bool is_elf(const std::string& path) {
  constexpr std::string_view magic =
      "\x7f"
      "ELF";
  std::array<char, magic.size()> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  return std::string_view(begin.data(), begin.size()) == magic;
}

}  // namespace

Result<std::unique_ptr<Port>> open_shared_library(const std::string& path) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) {
    if (std::filesystem::is_directory(path, unreadable)) {
      return fail_at(path, "is a folder; `--port lib:PATH` takes the path of a shared library");
    }
    return fail_at(path, "no such library; `--port lib:PATH` takes the path of a shared library");
  }
  // With an absolute path, the system does not search its own folders for the library.
  const std::string absolute = std::filesystem::absolute(path).string();
  const auto library = DynamicLibrary::open(absolute);
  if (!library) {
    return fail_at(path, fmt::format("cannot be loaded: {}{}", library.error().message,
                                     is_elf(path) ? "" : "; build it with `cc -shared -fPIC`"));
  }
  void* symbol = library->find(symbol_name);
  if (!symbol) {
    return fail_at(path, fmt::format("exports no {}(); is it declared with ATTEST_EXPORT and, in "
                                     "C++, extern \"C\"?",
                                     symbol_name));
  }
  const auto* unit = reinterpret_cast<const attest_unit* (*)()>(symbol)();
  if (auto checked = check_table(unit, path); !checked) return tl::unexpected(checked.error());
  auto port = std::make_unique<AbiPort>(*unit, library->handle());
  const auto wrong = wrong_in_declared(port->name(), port->version(), port->unsupported_groups());
  if (!wrong.empty()) return fail_at(path, fmt::format("what it declares is wrong: {}", wrong));
  if (const auto lacks = port->declared_lacks(); !lacks) {
    return fail_at(path, fmt::format("{}: {}", ATTEST_EXTENSION_LACKS, lacks.error().message));
  }
  return port;
}

}  // namespace attest
