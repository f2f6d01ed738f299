#include "controller/cascade/rate_unit.hpp"

#include "controller/cascade/rate_unit_definition.hpp"

namespace attest::cascade {

template class RateUnit<float>;
template class RateUnit<double>;

}  // namespace attest::cascade
