#include "harness/run/mixer_replay.hpp"

#include <bit>
#include <cstdint>
#include <filesystem>

#include <fmt/format.h>

#include "controller/actuation/mixer.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

using actuation::Mixer;

std::string difference(std::size_t sample, const std::string& signal, float got, float want) {
  return fmt::format("{} at sample {}: got {} (0x{:08x}), want {} (0x{:08x})", signal, sample, got,
                     std::bit_cast<std::uint32_t>(got), want, std::bit_cast<std::uint32_t>(want));
}

// The first difference of one sample, in words; empty when there is none.
std::string compare_sample(const MixerSample& want, std::size_t index, Mixer& mixer) {
  actuation::Saturation saturation{};
  const auto got =
      mixer.mix({want.roll, want.pitch, want.yaw, want.thrust}, want.delta_out_max, saturation);
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (std::bit_cast<std::uint32_t>(got[i]) != std::bit_cast<std::uint32_t>(want.out[i])) {
      return difference(index, fmt::format("out[{}]", i), got[i], want.out[i]);
    }
  }
  const auto flag = [&](const char* name, bool is, std::uint8_t should) -> std::string {
    if (is == (should != 0)) return "";
    return fmt::format("{} at sample {}: got {:d}, want {:d}", name, index, is, should != 0);
  };
  for (const auto& text : {flag("lower_limit", saturation.lower, want.lower_limit),
                           flag("upper_limit", saturation.upper, want.upper_limit),
                           flag("yaw_limit", saturation.yaw, want.yaw_limit)}) {
    if (!text.empty()) return text;
  }
  return "";
}

}  // namespace

Result<MixerReplay> replay_mixer(const MixerTrace& recorded, const std::string& definition) {
  auto mixer = Mixer::parse(definition);
  if (!mixer) return fail(fmt::format("mixer `{}`: {}", definition, mixer.error()));
  if (mixer->rotor_count() != recorded.rotors) {
    return fail_at(recorded.source, fmt::format("has {} rotors, mixer `{}` has {}", recorded.rotors,
                                                definition, mixer->rotor_count()));
  }
  MixerReplay replay;
  for (const MixerSample& sample : recorded.samples) {
    const std::string found = compare_sample(sample, replay.samples++, *mixer);
    if (found.empty()) continue;
    ++replay.deviating;
    if (replay.first.empty()) replay.first = found;
  }
  return replay;
}

std::optional<std::string> mixer_of(const std::string& trace_file) {
  const std::filesystem::path path(trace_file);
  const std::string stem = path.stem().string();
  if (const auto provenance = read_provenance(path.parent_path() / provenance_name)) {
    const auto found = provenance->mixers.find(stem);
    if (found != provenance->mixers.end()) return found->second;
  }
  const std::string unscaled = fmt::format("R: {} 10000 10000 10000 0", stem);
  if (Mixer::parse(unscaled)) return unscaled;
  return std::nullopt;
}

}  // namespace attest
