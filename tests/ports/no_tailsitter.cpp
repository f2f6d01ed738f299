// Right, and declares that it does not support tailsitter recovery: that group must be counted
// separately.
#include <cstring>

#include "controller/mc_att_control/mc_att_control.hpp"
#include "controller/mc_att_control/unit_table.hpp"

namespace {

const void* extension(const char* id) {
  return std::strcmp(id, ATTEST_EXTENSION_UNSUPPORTED_GROUPS) == 0 ? "tailsitter" : nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const attest_unit* attest_unit_v1(void) {
  using Table = attest::mc_att_control::UnitTable<attest::mc_att_control::McAttControl<float>>;
  static const attest_unit table = [] {
    attest_unit unit = Table::named("no tailsitter", "1");
    unit.extension = extension;
    return unit;
  }();
  return &table;
}
