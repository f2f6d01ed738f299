// The vectors of a folder of `attest vectors`: written for a suite, and checked against one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/core/result.hpp"
#include "harness/host/port_says.hpp"
#include "harness/recording/table_file.hpp"

namespace attest {

// Writes the inputs of the vectors that the port can run, a file each, and adds them to the
// folder's manifest, which is made if there is none (recording/manifest.hpp). Flights are left out,
// because their inputs depend on the outputs. Mixers are named in the provenance.toml next to the
// files. Returns the number of files. Errors: a file that cannot be read or written; the manifest
// is of a port with another fixed step; no vector is left.
Result<std::size_t> write_recorded_vectors(const std::filesystem::path& folder, TableFormat format,
                                           const std::vector<SelectedCase>& cases,
                                           std::optional<Rate> fixed_step);

struct RecordedVectors {
  std::size_t selected = 0;          // without flights
  std::size_t answered = 0;          // of these
  std::string first;                 // the first file of outputs
  std::vector<std::string> ignored;  // its columns that have no meaning to attest
};

// Errors: none of the selected vectors is answered; the inputs that the manifest was written with
// are not those that the case makes now.
Result<RecordedVectors> check_recorded_vectors(const std::filesystem::path& folder,
                                               const PortSays& port,
                                               const std::vector<SelectedCase>& cases);

}  // namespace attest
