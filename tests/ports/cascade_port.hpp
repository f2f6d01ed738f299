// The reference's cascade with some stages replaced, as a shared library: a port that computes in
// another way.
#pragma once

#include <cstring>

#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/cascade/rate_unit_definition.hpp"
#include "controller/cascade/unit_table.hpp"

// extension() of a port whose units are the classes AttitudeUnit and RateUnit.
template <typename AttitudeUnit, typename RateUnit>
const void* cascade_extension(const char* id) noexcept {
  using attest::cascade::UnitTable;
  if (id == nullptr) return nullptr;
  if (std::strcmp(id, ATTEST_EXTENSION_ATTITUDE_UNIT) == 0) {
    return &UnitTable<attest_attitude_unit, AttitudeUnit, attest_attitude_inputs,
                      attest_attitude_outputs>::table;
  }
  if (std::strcmp(id, ATTEST_EXTENSION_RATE_UNIT) == 0) {
    return &UnitTable<attest_rate_unit, RateUnit, attest_rate_inputs, attest_rate_outputs>::table;
  }
  return nullptr;
}

// A table that has these extensions and no controller of the older law.
#define ATTEST_CASCADE_PORT(name, extension)                                                  \
  extern "C" __attribute__((visibility("default"))) const attest_unit* attest_unit_v1(void) { \
    static constexpr attest_unit table{                                                       \
        ATTEST_UNIT_ABI_VERSION, name, "1", nullptr, nullptr, nullptr, nullptr, extension};   \
    return &table;                                                                            \
  }
