// The law in binary32.
#include "controller/mc_att_control/mc_att_control_definition.hpp"
#include "controller/mc_att_control/tailsitter_recovery_definition.hpp"

namespace attest::mc_att_control {

template class AttitudeControl<float>;
template class RateControl<float>;
template struct RecoveryStages<float>;
template class McAttControl<float>;
// Of the catalogue of faults (controller/faults), which takes their addresses.
template struct AttitudeStages<float>;
template struct RateStages<float>;
template struct StepStages<float>;

}  // namespace attest::mc_att_control
