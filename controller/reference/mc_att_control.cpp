#include "controller/reference/mc_att_control.hpp"

#include "controller/reference/mc_att_control_definition.hpp"

namespace attest::reference {

template class McAttControl<float>;
template class McAttControl<double>;

}  // namespace attest::reference
