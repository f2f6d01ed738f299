// The functions that make a controller available through the C ABI of attest_unit.h.
#pragma once

#include <new>

#include "controller/attest_unit.h"
#include "controller/mc_att_control/profile.hpp"

namespace attest::mc_att_control {

// Controller has a constructor from a Profile, set_parameter() and step(), as McAttControl does.
// Every function is noexcept: an exception must not cross into a host written in C.
template <typename Controller>
struct UnitTable {
  static void* create(const char* profile_name) noexcept {
    if (profile_name == nullptr) return nullptr;
    const auto profile = profile_from_name(profile_name);
    return profile ? new (std::nothrow) Controller(*profile) : nullptr;
  }

  static void destroy(void* self) noexcept { delete static_cast<Controller*>(self); }

  static int set_parameter(void* self, const char* name, float value) noexcept {
    if (self == nullptr || name == nullptr) return ATTEST_INVALID;
    return static_cast<Controller*>(self)->set_parameter(name, value) ? ATTEST_OK : ATTEST_INVALID;
  }

  static int step(void* self, const attest_inputs* in, attest_outputs* out) noexcept {
    if (self == nullptr || in == nullptr || out == nullptr) return ATTEST_INVALID;
    static_cast<Controller*>(self)->step(*in, *out);
    return ATTEST_OK;
  }

  using Extension = decltype(attest_unit::extension);

  static constexpr attest_unit named(const char* name, const char* version,
                                     Extension extension = nullptr) {
    return {ATTEST_UNIT_ABI_VERSION, name, version,  create, destroy,
            set_parameter,           step, extension};
  }
};

}  // namespace attest::mc_att_control
