#include "controller/mc_att_control/unit.hpp"

#include "controller/actuation/unit_table.hpp"
#include "controller/mc_att_control/mc_att_control.hpp"
#include "controller/mc_att_control/unit_table.hpp"

#ifndef ATTEST_REFERENCE_SCALAR
#define ATTEST_REFERENCE_SCALAR float
#endif

#ifndef ATTEST_REFERENCE_VERSION
#define ATTEST_REFERENCE_VERSION "unversioned"
#endif

namespace attest::mc_att_control {
namespace {

template <typename Scalar>
constexpr attest_unit table = UnitTable<McAttControl<Scalar>>::named("attest-reference",
                                                                     ATTEST_REFERENCE_VERSION,
                                                                     actuation::extension<Scalar>);

}  // namespace

const attest_unit* mc_att_control_unit() { return &table<ATTEST_REFERENCE_SCALAR>; }

const attest_unit* mc_att_control_unit_in_double() { return &table<double>; }

}  // namespace attest::mc_att_control
