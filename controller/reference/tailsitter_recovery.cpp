#include "controller/reference/tailsitter_recovery_definition.hpp"

namespace attest::reference {

template struct RecoveryStages<float>;
template struct RecoveryStages<double>;

}  // namespace attest::reference
