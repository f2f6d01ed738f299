// The functions that make the two pure laws, of every profile, available through attest_law.h.
//
// Every function is noexcept: an exception must not cross into a host written in C.
#pragma once

#include <memory>
#include <new>
#include <string_view>
#include <utility>
#include <variant>

#include "controller/attest_law.h"
#include "controller/cascade/pure_laws.hpp"
#include "controller/mc_att_control/pure_laws.hpp"

namespace attest::cascade {

// The law of a profile: New is that of v1.14 and later, Old that of v1.5.5 and v1.3.4. Null if the
// profile is unknown or no memory is left. The last arguments are the stages of both.
template <typename New, typename Old, typename StagesOfNew, typename StagesOfOld>
std::unique_ptr<std::variant<New, Old>> make_law(std::string_view profile,
                                                 const StagesOfNew& of_new,
                                                 const StagesOfOld& of_old) {
  using Law = std::variant<New, Old>;
  if (const auto known = profile_from_name(profile)) {
    return std::unique_ptr<Law>(new (std::nothrow) Law(std::in_place_type<New>, *known, of_new));
  }
  if (const auto known = mc_att_control::profile_from_name(profile)) {
    return std::unique_ptr<Law>(new (std::nothrow) Law(std::in_place_type<Old>, *known, of_old));
  }
  return nullptr;
}

template <typename Law, typename In, typename Out>
void step_law(Law& law, const In& in, Out& out) {
  std::visit([&](auto& one) { one.step(in, out); }, law);
}

// Table is attest_attitude_law or attest_rate_law; StagesOfNew are those of the unit.
template <typename Table, typename New, typename Old, typename StagesOfNew, typename StagesOfOld,
          typename In, typename Out>
struct LawTable {
  using Law = std::variant<New, Old>;

  static void* create(const char* profile) noexcept {
    if (profile == nullptr) return nullptr;
    return make_law<New, Old>(profile, StagesOfNew(), StagesOfOld()).release();
  }
  static void destroy(void* self) noexcept { delete static_cast<Law*>(self); }
  static int step(void* self, const In* in, Out* out) noexcept {
    if (self == nullptr || in == nullptr || out == nullptr) return ATTEST_INVALID;
    step_law(*static_cast<Law*>(self), *in, *out);
    return ATTEST_OK;
  }

  static constexpr Table table{create, destroy, step};
};

template <typename Scalar>
using AttitudeLawTable =
    LawTable<attest_attitude_law, PureAttitudeLaw<Scalar>, mc_att_control::PureAttitudeLaw<Scalar>,
             AttitudeUnitLaw<Scalar>, mc_att_control::McAttControlLaw<Scalar>,
             attest_attitude_law_inputs, attest_attitude_law_outputs>;
template <typename Scalar>
using RateLawTable =
    LawTable<attest_rate_law, PureRateLaw<Scalar>, mc_att_control::PureRateLaw<Scalar>,
             RateUnitLaw<Scalar>, mc_att_control::McAttControlLaw<Scalar>, attest_rate_law_inputs,
             attest_rate_law_outputs>;

}  // namespace attest::cascade
