#include "controller/reference/attitude_control.hpp"

namespace attest::reference {

template class AttitudeControl<float>;
template class AttitudeControl<double>;

}  // namespace attest::reference
