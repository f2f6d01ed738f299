// The reference's mixer against a recorded mixer trace, to the bit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "harness/core/result.hpp"
#include "harness/trace/mixer_csv.hpp"

namespace attest {

struct MixerReplay {
  std::size_t samples = 0;
  std::size_t deviating = 0;  // samples with any output or flag that differs
  std::string first;          // what differs first, in words; empty when nothing does
};

// `mixer` is its definition, "R: 4x 10000 10000 10000 0". Errors: a definition that is none, or one
// with another number of rotors than the trace has.
Result<MixerReplay> replay_mixer(const MixerTrace& recorded, const std::string& mixer);

// The definition for a trace: the provenance.toml beside it says, or else the file is named after
// an unscaled geometry ("4x.csv"). Empty when neither is so.
std::optional<std::string> mixer_of(const std::string& trace_file);

}  // namespace attest
