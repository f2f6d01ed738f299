#include "controller/cascade/attitude_unit.hpp"

#include "controller/cascade/attitude_unit_definition.hpp"

namespace attest::cascade {

template class AttitudeUnit<float>;
template class AttitudeUnit<double>;

}  // namespace attest::cascade
