#include "controller/mc_att_control/unit.hpp"

#include "controller/mc_att_control/mc_att_control.hpp"
#include "controller/mc_att_control/reference_table.hpp"

namespace attest::mc_att_control {

const attest_unit* mc_att_control_unit() { return &reference_table<ATTEST_REFERENCE_SCALAR>; }

}  // namespace attest::mc_att_control
