#include "controller/mc_att_control/unit.hpp"

#include "controller/mc_att_control/mc_att_control.hpp"
#include "controller/mc_att_control/reference_table.hpp"

#ifndef ATTEST_REFERENCE_SCALAR
#define ATTEST_REFERENCE_SCALAR float
#endif

namespace attest::mc_att_control {

const attest_unit* mc_att_control_unit() { return &reference_table<ATTEST_REFERENCE_SCALAR>; }

}  // namespace attest::mc_att_control
