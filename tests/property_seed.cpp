// Sets the seed of the properties of all unit tests, so that a run can be repeated. RC_PARAMS, set
// by the user, decides instead. rapidcheck reads it when the first property runs.

#include <cstdlib>

namespace {

[[maybe_unused]] const int seeded = setenv("RC_PARAMS", "seed=20160601", 0);

}  // namespace
