#include "controller/mc_att_control/mc_att_control.hpp"

#include "controller/mc_att_control/mc_att_control_definition.hpp"

namespace attest::mc_att_control {

template class McAttControl<float>;
template class McAttControl<double>;

}  // namespace attest::mc_att_control
