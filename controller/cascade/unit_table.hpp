// The functions that make the two units available through attest_cascade.h.
//
// Every function is noexcept: an exception must not cross into a host written in C.
#pragma once

#include <cstring>
#include <new>

#include "controller/attest_cascade.h"
#include "controller/cascade/attitude_unit.hpp"
#include "controller/cascade/law_table.hpp"
#include "controller/cascade/profile.hpp"
#include "controller/cascade/rate_unit.hpp"

namespace attest::cascade {

// Table is attest_attitude_unit or attest_rate_unit. Unit is a class with a constructor from a
// Profile, set_parameter() and step().
template <typename Table, typename Unit, typename Inputs, typename Outputs>
struct UnitTable {
  static void* create(const char* profile_name) noexcept {
    if (profile_name == nullptr) return nullptr;
    const auto profile = profile_from_name(profile_name);
    return profile ? new (std::nothrow) Unit(*profile) : nullptr;
  }

  static void destroy(void* self) noexcept { delete static_cast<Unit*>(self); }

  static int set_parameter(void* self, const char* name, float value) noexcept {
    if (self == nullptr || name == nullptr) return ATTEST_INVALID;
    return static_cast<Unit*>(self)->set_parameter(name, value) ? ATTEST_OK : ATTEST_INVALID;
  }

  static int step(void* self, const Inputs* in, Outputs* out) noexcept {
    if (self == nullptr || in == nullptr || out == nullptr) return ATTEST_INVALID;
    static_cast<Unit*>(self)->step(*in, *out);
    return ATTEST_OK;
  }

  static constexpr Table table{create, destroy, set_parameter, step};
};

template <typename Scalar>
using AttitudeUnitTable = UnitTable<attest_attitude_unit, AttitudeUnit<Scalar>,
                                    attest_attitude_inputs, attest_attitude_outputs>;
template <typename Scalar>
using RateUnitTable =
    UnitTable<attest_rate_unit, RateUnit<Scalar>, attest_rate_inputs, attest_rate_outputs>;

// extension() of a port that has both units and the laws of every profile.
template <typename Scalar>
const void* extension(const char* id) noexcept {
  if (id == nullptr) return nullptr;
  if (std::strcmp(id, ATTEST_EXTENSION_ATTITUDE_UNIT) == 0) {
    return &AttitudeUnitTable<Scalar>::table;
  }
  if (std::strcmp(id, ATTEST_EXTENSION_RATE_UNIT) == 0) return &RateUnitTable<Scalar>::table;
  if (std::strcmp(id, ATTEST_EXTENSION_ATTITUDE_LAW) == 0) return &AttitudeLawTable<Scalar>::table;
  if (std::strcmp(id, ATTEST_EXTENSION_RATE_LAW) == 0) return &RateLawTable<Scalar>::table;
  return nullptr;
}

}  // namespace attest::cascade
