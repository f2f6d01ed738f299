// The law in binary32.
#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/cascade/rate_unit_definition.hpp"

namespace attest::cascade {

template class AttitudeUnit<float>;
template class RateUnit<float>;

}  // namespace attest::cascade
