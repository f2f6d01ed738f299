// provenance.toml: the origin of the traces of a folder, and the values that are the same in all of
// them, which the traces leave out.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/csv.hpp"

namespace attest {

struct Provenance {
  std::string profile;                      // "px4-v1.5.5"
  std::string case_id;                      // empty for traces that were not made from a case
  std::string case_sha256;                  // of the case file
  std::string reference;                    // "attest 0.1.0"
  std::string compiler;                     // "gcc 12.2.0"
  std::string reason;                       // why this golden was blessed
  std::vector<std::string> covers;          // for recordings: the groups whose behaviour they show
  std::map<std::string, double> constants;  // channel or in/parameter.<NAME> -> value
  std::map<std::string, std::string>
      mixers;  // stem of a mixer trace -> "R: 4x 8000 9000 5000 1500"
  std::map<std::string, std::string> sha256;  // file name -> hash
  // A folder of other traces, as a path relative to this folder; empty if there is no base. A trace
  // here takes the columns and constants that it lacks from the trace of the same name there.
  std::string base;
  std::map<std::string, std::string> base_sha256;  // file name in the base -> hash
  // For flights: stem of a trace -> its horizon [s], how long two correct controllers agree.
  std::map<std::string, double> horizon_s;
  // "<stem>.<metric>" -> the value in the reference's flight.
  std::map<std::string, double> metrics;
  std::map<std::string, std::string> models;  // name of a vehicle's file -> SHA-256
};

inline constexpr const char* provenance_name = "provenance.toml";

// The keys are the members' names; all are optional. Errors: unreadable file, not TOML, an unknown
// key, a constant that names no channel or parameter, the constant `timestamp`, a constant that is
// not a value of its channel, a negative tolerance.
Result<Provenance> read_provenance(const std::filesystem::path& file);
// The same for the text of the file.
Result<Provenance> parse_provenance(std::string_view text, const std::filesystem::path& file);

// The provenance of a folder; an empty one if the folder has no such file. Errors: those of
// read_provenance().
Result<Provenance> provenance_in(const std::filesystem::path& folder);

std::string to_toml(const Provenance& provenance);

// Sets the profile in the folder's provenance, and adds `mixers` to it (as Provenance::mixers).
// Errors: those of read_provenance(); the file cannot be written.
Result<void> add_origin(const std::filesystem::path& folder, const std::string& profile,
                        const std::map<std::string, std::string>& mixers);

// Appends the SHA-256 of the text as a last line, which is a comment in TOML.
std::string sealed(std::string_view toml);

// `text` is that of the file. Errors: it was changed after it was sealed, or has no seal.
Result<void> check_seal(std::string_view text, const std::filesystem::path& file);

// Divides the columns of traces that will be in one folder. A channel that has the same value in
// every sample of all traces (by bits, NaN = NaN) goes to `constants`. So does a parameter that has
// the same value from tick 0 on in all traces that have parameters. The other channels and
// parameters, and timestamp, stay columns. REQUIRES: each trace has a sample; all have the same
// channels; each has no parameters, or those of the first trace.
struct Division {
  CsvColumns columns;
  std::map<std::string, double> constants;
};
Division divide(const std::vector<Trace>& traces);

// The same for traces that have a base (Provenance::base). A channel that has the same values in
// the base, sample by sample, is neither column nor constant, and neither are the parameters.
// REQUIRES: as above; `base` has as many traces, of the same lengths, with the same parameters.
Division divide(const std::vector<Trace>& traces, const std::vector<Trace>& base);

}  // namespace attest
