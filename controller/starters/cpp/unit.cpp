/* SPDX-License-Identifier: BSD-3-Clause */
// The C ABI of attest_unit.h around a Controller. No function here throws.
#include <new>

#include <attest_unit.h>

#include "controller.hpp"

namespace {

using starter::Controller;

void* create(const char* profile_name) noexcept {
  const auto profile = starter::profile_of(profile_name);
  if (!profile) return nullptr;
  return new (std::nothrow) Controller(*profile);
}

void destroy(void* self) noexcept { delete static_cast<Controller*>(self); }

int set_parameter(void* self, const char* name, float value) noexcept {
  return static_cast<Controller*>(self)->set_parameter(name, value) ? ATTEST_OK : ATTEST_INVALID;
}

int step(void* self, const attest_inputs* in, attest_outputs* out) noexcept {
  static_cast<Controller*>(self)->step(*in, *out);
  return ATTEST_OK;
}

constexpr attest_unit unit = {
    ATTEST_UNIT_ABI_VERSION,
    "attest-starter-cpp",
    "0.1.0",
    create,
    destroy,
    set_parameter,
    step,
    nullptr,  // no extensions
};

}  // namespace

const attest_unit* attest_unit_v1() { return &unit; }
