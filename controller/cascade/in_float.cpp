// The law in binary32.
#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/cascade/rate_unit_definition.hpp"

namespace attest::cascade {

template class AttitudeUnit<float>;
template class RateUnit<float>;
// Of the catalogue of faults (controller/faults), which takes their addresses.
template struct AttitudeStages<float>;
template struct AttitudeStepStages<float>;
template struct RateStages<float>;
template struct RateStepStages<float>;
template struct ReferenceModelStages<float>;
template struct StickStages<float>;

}  // namespace attest::cascade
