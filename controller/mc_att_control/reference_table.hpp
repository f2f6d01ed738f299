// The reference's table of functions, in a precision of choice.
#pragma once

#include "controller/actuation/unit_table.hpp"
#include "controller/mc_att_control/mc_att_control.hpp"
#include "controller/mc_att_control/unit_table.hpp"
#include "controller/reference_build.hpp"

namespace attest::mc_att_control {

template <typename Scalar>
inline constexpr attest_unit reference_table = UnitTable<McAttControl<Scalar>>::named(
    "attest-reference", ATTEST_REFERENCE_VERSION, actuation::extension<Scalar>);

}  // namespace attest::mc_att_control
