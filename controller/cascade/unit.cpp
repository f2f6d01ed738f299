#include "controller/cascade/unit.hpp"

#include "controller/cascade/reference_table.hpp"
#include "controller/cascade/whole.hpp"
#include "controller/mc_att_control/unit.hpp"

namespace attest::cascade {

const attest_unit* cascade_unit() { return &reference_table<ATTEST_REFERENCE_SCALAR>; }

const attest_unit* whole_reference() {
  return whole<mc_att_control::mc_att_control_unit, cascade_unit>();
}

}  // namespace attest::cascade
