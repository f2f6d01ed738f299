// The law in binary64. A build of the reference in one precision leaves this file out.
#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/cascade/rate_unit_definition.hpp"
#include "controller/cascade/reference_table.hpp"
#include "controller/cascade/unit.hpp"
#include "controller/cascade/whole.hpp"
#include "controller/mc_att_control/unit.hpp"

namespace attest::cascade {

template class AttitudeUnit<double>;
template class RateUnit<double>;

const attest_unit* cascade_unit_in_double() { return &reference_table<double>; }

const attest_unit* whole_reference_in_double() {
  return whole<mc_att_control::mc_att_control_unit_in_double, cascade_unit_in_double>();
}

}  // namespace attest::cascade
