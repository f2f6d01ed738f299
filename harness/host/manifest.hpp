// manifest.toml of a folder that `attest vectors` wrote: which inputs it has, and how the outputs
// next to them are to be read.
//
//     DIR/manifest.toml
//     DIR/px4-v1.5.5/attitude/roll_30/250hz.csv       inputs; or .mat
//     DIR/px4-v1.5.5/attitude/roll_30/250hz.out.csv   outputs, by the user; or .mat
//
// `attest vectors` writes it. The user changes values in the tables [port], [outputs] and
// [columns].
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/rate.hpp"
#include "harness/core/result.hpp"
#include "harness/host/file_format.hpp"
#include "harness/port/lacks.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

inline constexpr const char* manifest_name = "manifest.toml";

struct Manifest {
  // [port]: the declarations of the port, as the ABI's functions and extensions give them.
  std::string port_name = "recorded";
  std::string port_version;
  std::vector<std::string> unsupported_groups;
  Lacks lacks;  // the files need not have its outputs
  std::optional<int> fraction_bits;
  std::optional<Rate> fixed_step;  // if set, the first timestamp is one period

  // [outputs]
  std::string time = "us";  // unit of the column `timestamp`: "s", "ms" or "us"

  // [columns]: from a name in the files of outputs to the name of a channel.
  std::map<std::string, std::string> columns;

  // [parameters]: those of `attest vectors --param`, which replace those of the cases.
  std::vector<ParameterChange> parameters;

  // [vectors]: from an id, "px4-v1.5.5/attitude/roll_30@250hz", to the SHA-256 of its inputs.
  std::map<std::string, std::string> vectors;
};

// Errors: the file cannot be read; not TOML; an unknown key, channel or unit; an invalid
// arithmetic or rate.
Result<Manifest> read_manifest(const std::filesystem::path& folder);

// Writes a temporary file and renames it. Errors: the file cannot be written.
Result<void> write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

// The hash covers all inputs and parameters of the trace at all ticks.
std::string sha256_of_inputs(const Trace& trace);

// The file of a vector's inputs, relative to the folder: "px4-v1.5.5/attitude/roll_30/250hz.csv".
std::filesystem::path input_file(const std::string& vector_id, const FileFormat& format);

// The file of a vector's outputs; empty if there is none. Errors: there are several.
Result<std::filesystem::path> find_output_file(const std::filesystem::path& folder,
                                               const std::string& vector_id);

// The path that the outputs of a vector should have, for messages: "DIR/.../250hz.out.csv".
std::string wanted_output_file(const std::filesystem::path& folder, const std::string& vector_id);

}  // namespace attest
