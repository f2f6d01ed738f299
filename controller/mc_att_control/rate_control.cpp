#include "controller/mc_att_control/rate_control.hpp"

namespace attest::mc_att_control {

template class RateControl<float>;
template class RateControl<double>;

}  // namespace attest::mc_att_control
