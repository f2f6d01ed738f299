#include "controller/mc_att_control/attitude_control.hpp"

namespace attest::mc_att_control {

template class AttitudeControl<float>;
template class AttitudeControl<double>;

}  // namespace attest::mc_att_control
