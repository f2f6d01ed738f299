#include "controller/reference/rate_control.hpp"

namespace attest::reference {

template class RateControl<float>;
template class RateControl<double>;

}  // namespace attest::reference
