#include "controller/reference/unit.hpp"

#include "controller/actuation/unit_table.hpp"
#include "controller/reference/mc_att_control.hpp"
#include "controller/reference/unit_table.hpp"

#ifndef ATTEST_REFERENCE_SCALAR
#define ATTEST_REFERENCE_SCALAR float
#endif

#ifndef ATTEST_REFERENCE_VERSION
#define ATTEST_REFERENCE_VERSION "unversioned"
#endif

namespace attest::reference {
namespace {

template <typename Scalar>
constexpr attest_unit table = UnitTable<McAttControl<Scalar>>::named("attest-reference",
                                                                     ATTEST_REFERENCE_VERSION,
                                                                     actuation::extension<Scalar>);

}  // namespace

const attest_unit* reference_unit() { return &table<ATTEST_REFERENCE_SCALAR>; }

const attest_unit* reference_unit_in_double() { return &table<double>; }

}  // namespace attest::reference
