// The rows behind modules(), name_of(Stage) and channels(), for this folder.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <type_traits>

#include "harness/trace/channels.hpp"

namespace attest {

// The functions of ModuleAbi for the tables of a type.
template <typename Table, typename In, typename Out>
struct AbiOf {
  static constexpr bool has_parameters = requires(Table table) { table.set_parameter; };

  static const Table& of(const void* table) { return *static_cast<const Table*>(table); }
  static bool is_complete(const void* table) {
    if constexpr (has_parameters) {
      if (of(table).set_parameter == nullptr) return false;
    }
    return of(table).create && of(table).destroy && of(table).step;
  }
  static void* create(const void* table, const char* profile, const char* definition) {
    if constexpr (std::is_invocable_v<decltype(Table::create), const char*, const char*>) {
      return of(table).create(profile, definition);
    } else {
      return of(table).create(profile);
    }
  }
  static void destroy(const void* table, void* self) { of(table).destroy(self); }
  static int set_parameter(const void* table, void* self, const char* name, float value) {
    if constexpr (has_parameters) return of(table).set_parameter(self, name, value);
    return ATTEST_INVALID;
  }
  static int step(const void* table, void* self, const void* in, void* out) {
    return of(table).step(self, static_cast<const In*>(in), static_cast<Out*>(out));
  }
};

template <typename Table, typename In, typename Out>
constexpr ModuleAbi abi_of(int (*Table::*)(void*, const In*, Out*)) {
  using Abi = AbiOf<Table, In, Out>;
  return {Abi::is_complete, Abi::create, Abi::destroy, Abi::set_parameter, Abi::step};
}

extern const std::array<ModuleInfo, module_count> module_table;
extern const std::array<std::string_view, stage_count> stage_names;
extern const std::span<const Channel> channel_table;

}  // namespace attest
