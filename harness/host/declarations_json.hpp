// The declarations of a port in the greeting of its process (host_protocol.hpp).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/core/json_reader.hpp"
#include "harness/host/declarations.hpp"

namespace attest {

nlohmann::json to_json(const Declarations& says);

// Reports each member that is missing, of another type or out of its range. `of_program`: the port
// is a program.
Declarations declarations_from(JsonReader in, bool of_program);

}  // namespace attest
