// A host of recorded outputs: it answers with what the files of a folder say.
#pragma once

#include <filesystem>
#include <memory>

#include "harness/core/result.hpp"
#include "harness/host/port_host.hpp"

namespace attest {

// The folder of `attest vectors`, with outputs (recording/manifest.hpp). The host identifies a
// vector by Trace::source, its id. Requests:
//
//     drive         the outputs of the vector's file. A vector without a file, or with several
//                   instances of the port, is unanswered. A file that cannot be used is a fault of
//                   kind protocol
//     fly           unanswered
//     time_steps    unanswered
//     supports      true if the manifest has a vector of the profile
//
// No code of a port runs. Errors: no folder or manifest; the manifest is malformed; no vector has
// outputs.
Result<std::unique_ptr<PortHost>> open_recorded_host(const std::filesystem::path& folder);

}  // namespace attest
