// Mixer traces as CSV: the controls a mixer was given, and the motor outputs and limit flags it
// answered with, a row a call. The same rules for numbers and errors as csv.hpp.
//
// Columns: roll, pitch, yaw, thrust, delta_out_max, out[0] ... out[rotors - 1], lower_limit,
// upper_limit, yaw_limit. The geometry is not in the file: provenance.toml has it under [mixers].
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/file.hpp"
#include "harness/core/result.hpp"

namespace attest {

inline constexpr std::size_t max_rotors = 8;

struct MixerSample {
  float roll;    // [-1..1] dimensionless actuator control
  float pitch;   // [-1..1]
  float yaw;     // [-1..1]
  float thrust;  // [0..1]
  // How far an output may move from the call before; 0 is no limit.
  float delta_out_max;
  std::array<float, max_rotors> out;  // [-1..1] a rotor; the first MixerTrace::rotors are used
  std::uint8_t lower_limit;           // flag: a motor is at its minimum
  std::uint8_t upper_limit;           // flag: a motor is at its maximum
  std::uint8_t yaw_limit;             // flag: yaw was cut to keep roll and pitch
};

struct MixerTrace {
  std::string source;      // file, for messages
  std::size_t rotors = 0;  // 4, 6 or 8
  std::vector<MixerSample> samples;
};

// Errors as in csv.hpp: unreadable file, no header, unknown, repeated or missing column, a number
// of out[] columns other than 4, 6 and 8, a bad row or cell, no rows.
Result<MixerTrace> read_mixer_csv(const std::filesystem::path& path);

Result<void> write_mixer_csv(const MixerTrace& trace, AtomicFile& file);

// Does the header have a column that only mixer traces have? False for a file that has no header
// or cannot be read.
bool looks_like_mixer_csv(const std::filesystem::path& path);

}  // namespace attest
