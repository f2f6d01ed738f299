#include "controller/reference/unit.hpp"

#include <new>

#include "controller/reference/mc_att_control.hpp"
#include "controller/reference/profile.hpp"

#ifndef ATTEST_REFERENCE_SCALAR
#define ATTEST_REFERENCE_SCALAR float
#endif

#ifndef ATTEST_REFERENCE_VERSION
#define ATTEST_REFERENCE_VERSION "unversioned"
#endif

namespace attest::reference {
namespace {

// Every function is noexcept: an exception must not cross into a host written in C.
template <typename Scalar>
struct Functions {
  using Controller = McAttControl<Scalar>;

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

  static constexpr attest_unit table{
      ATTEST_UNIT_ABI_VERSION,
      "attest-reference",
      ATTEST_REFERENCE_VERSION,
      create,
      destroy,
      set_parameter,
      step,
      nullptr,
  };
};

}  // namespace

const attest_unit* reference_unit() { return &Functions<ATTEST_REFERENCE_SCALAR>::table; }

const attest_unit* reference_unit_in_double() { return &Functions<double>::table; }

}  // namespace attest::reference
