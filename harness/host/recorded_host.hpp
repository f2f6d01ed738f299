// A host that answers with the recorded outputs in the files of a folder.
#pragma once

#include <filesystem>
#include <memory>

#include "harness/core/result.hpp"
#include "harness/host/port_host.hpp"

namespace attest {

// `folder` was made by `attest vectors`, and outputs were added (host/manifest.hpp). The host
// identifies a vector by its id, Trace::source. Requests:
//
//     drive         the outputs in the vector's file. Fault Kind::unanswered: the vector has no
//                   file, is not in the manifest, or needs several instances of the port.
//                   Fault Kind::protocol: its file cannot be used
//     fly           fault Kind::unanswered
//     fly_live      fault Kind::unanswered
//     time_steps    fault Kind::unanswered
//     supports      true if the manifest has a vector of the profile
//
// No code of a port runs. Errors: no folder or manifest; the manifest is malformed; no vector has
// outputs.
Result<std::unique_ptr<PortHost>> open_recorded_host(const std::filesystem::path& folder);

}  // namespace attest
