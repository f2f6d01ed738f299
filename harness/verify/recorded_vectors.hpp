// Writes vectors to a folder of `attest vectors`, and checks such a folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/core/result.hpp"
#include "harness/host/declarations.hpp"
#include "harness/host/file_format.hpp"

namespace attest {

// Writes the inputs of the vectors that a recorded port can run, a file each, and adds them to the
// folder's manifest, which is made if there is none (host/manifest.hpp). Leaves out flights
// (their inputs depend on the outputs), cases with two instances, and vectors that do not keep
// `fixed_step`. `parameters` replace those of the cases. The provenance.toml next to the files has
// the mixer definitions. Returns the number of files. Errors: a file cannot be read or written; the
// manifest has another fixed step or other parameters; no vector is left.
Result<std::size_t> write_recorded_vectors(const std::filesystem::path& folder,
                                           const FileFormat& format,
                                           const std::vector<SelectedCase>& cases,
                                           std::optional<Rate> fixed_step,
                                           const std::vector<ParameterChange>& parameters);

struct RecordedVectors {
  std::size_t selected = 0;          // vectors that a recorded port can run
  std::size_t answered = 0;          // of these, the vectors with a file of outputs
  std::string first;                 // the first file of outputs
  std::vector<std::string> ignored;  // columns of that file that attest does not know
};

// Finds the outputs of the selected vectors. Errors: no vector has outputs; the inputs of a vector
// with outputs are not those that its case makes now; the manifest cannot be read.
Result<RecordedVectors> check_recorded_vectors(const std::filesystem::path& folder,
                                               const Declarations& port,
                                               const std::vector<SelectedCase>& cases);

}  // namespace attest
