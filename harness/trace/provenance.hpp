// provenance.toml: where the traces of a folder came from and the values that are the same in all
// of them, so that each trace together with this file is complete.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/csv.hpp"

namespace attest {

struct Provenance {
  std::string profile;                      // "px4-v1.5.5"
  std::string case_id;                      // empty for traces that no case made
  std::string case_sha256;                  // of the case file
  std::string reference;                    // "attest 0.1.0"
  std::string compiler;                     // "gcc 12.2.0"
  std::string reason;                       // why this golden was blessed
  std::vector<std::string> covers;          // of recordings: the groups whose behaviour they show
  std::map<std::string, double> constants;  // channel or in/parameter.<NAME> -> value
  std::map<std::string, std::string>
      mixers;  // stem of a mixer trace -> "R: 4x 8000 9000 5000 1500"
  // Stem of a trace -> absolute tolerance of its outputs, where their bits are the platform's (its
  // transcendental functions) and not the law's.
  std::map<std::string, double> tolerances;
  std::map<std::string, std::string> sha256;  // file name -> hash
  // A folder of other traces, relative to this one: a trace here has the columns and constants of
  // the trace of the same name there, except those that it has itself. Empty: it has all.
  std::string base;
  std::map<std::string, std::string> base_sha256;  // file name there -> hash
  // Of flights. Stem of a trace -> seconds of it that two right controllers stay together.
  std::map<std::string, double> horizon_s;
  // "<stem>.<metric>" -> what the reference's flight measured.
  std::map<std::string, double> metrics;
  std::map<std::string, std::string> models;  // file name -> SHA-256 of the vehicle's files
};

inline constexpr const char* provenance_name = "provenance.toml";

// The keys are the members' names; none is required. Errors: unreadable file, not TOML, an unknown
// key, a constant that is no channel or parameter, `timestamp`, or not a value of its channel.
Result<Provenance> read_provenance(const std::filesystem::path& file);

// Of a folder; an empty one when it has none. Errors: as above, of one that is there.
Result<Provenance> provenance_in(const std::filesystem::path& folder);

std::string to_toml(const Provenance& provenance);

// A text with its own SHA-256 in a last line, which is a comment of TOML.
std::string sealed(const std::string& toml);

// Errors: the file cannot be read; it is not as it was sealed, or has no seal.
Result<void> check_seal(const std::filesystem::path& file);

// Divides the columns of traces that will stand in one folder: what has the same value in every
// sample of all of them (by bits, NaN = NaN) goes to `constants`, the rest stays a column in each.
// So does a parameter that has the same value from tick 0 on in all of them. timestamp stays a
// column. REQUIRES: all traces have the same channels and parameter names; none is empty.
struct Division {
  CsvColumns columns;
  std::map<std::string, double> constants;
};
Division divide(const std::vector<Trace>& traces);

// The same for traces that have `base` (Provenance): what is the same there, sample by sample, is
// left out. REQUIRES: as above; as many traces in `base`, of the same lengths, with the same
// parameters.
Division divide(const std::vector<Trace>& traces, const std::vector<Trace>& base);

}  // namespace attest
