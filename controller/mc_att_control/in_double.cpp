// The law in binary64. A build of the reference in one precision leaves this file out.
#include "controller/mc_att_control/mc_att_control_definition.hpp"
#include "controller/mc_att_control/reference_table.hpp"
#include "controller/mc_att_control/tailsitter_recovery_definition.hpp"
#include "controller/mc_att_control/unit.hpp"

namespace attest::mc_att_control {

template class AttitudeControl<double>;
template class RateControl<double>;
template struct RecoveryStages<double>;
template class McAttControl<double>;

const attest_unit* mc_att_control_unit_in_double() { return &reference_table<double>; }

}  // namespace attest::mc_att_control
