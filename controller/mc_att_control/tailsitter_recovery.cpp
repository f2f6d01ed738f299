#include "controller/mc_att_control/tailsitter_recovery_definition.hpp"

namespace attest::mc_att_control {

template struct RecoveryStages<float>;
template struct RecoveryStages<double>;

}  // namespace attest::mc_att_control
