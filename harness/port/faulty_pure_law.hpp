// The pure laws of attest_law.h with faults of the catalogue.
#pragma once

#include <memory>
#include <string>

#include "controller/faults/faulty_law.hpp"
#include "harness/port/port.hpp"

namespace attest {

// `module` is attitude_law or rate_law. Null if the profile is unknown. A fault in the inputs or
// outputs of the unit acts on those that the law has, too.
std::unique_ptr<Unit> make_faulty_law(Module module, const std::string& profile,
                                      const faults::FaultyLaw& law);

}  // namespace attest
