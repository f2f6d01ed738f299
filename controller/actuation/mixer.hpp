// The multirotor mixer: from torque and thrust controls to motor commands, with saturation.
//
// Motor commands are -1 (stopped) .. 1 (full). mix() does not allocate; a mixer holds the previous
// commands and belongs to one thread at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "controller/actuation/mixer_geometry.hpp"
#include "controller/actuation/mixer_stages.hpp"

namespace attest::actuation {

inline constexpr std::size_t rotors_max = 8;

struct MixerDefinition {
  std::span<const Rotor> rotors;  // of the static geometry table
  float roll_scale, pitch_scale, yaw_scale;
  float idle;  // command of a motor at an output of 0
};

// Parses one line of a mixer file, "R: <geometry> <roll> <pitch> <yaw> <deadband>", such as
// "R: 4x 10000 10000 10000 0". Geometries: 4x 4+ 6x 8x. The numbers are integers in 1/10000: scales
// of the controls, and the fraction of the range in which a motor does not turn. The error
// describes the mistake in the text.
tl::expected<MixerDefinition, std::string> parse_mixer(std::string_view text);

// Stages is a policy: the stages of mixer_stages.hpp, or wrong ones (controller/faults).
template <typename Scalar, typename Stages = MixerStages<Scalar>>
class BasicMixer {
 public:
  using Controls = MixerControls<Scalar>;

  explicit BasicMixer(const MixerDefinition& definition, const Stages& stages = {})
      : rotors_(definition.rotors),
        scales_{Scalar(definition.roll_scale), Scalar(definition.pitch_scale),
                Scalar(definition.yaw_scale), Scalar(definition.idle)},
        stages_(stages),
        has_previous_(stages_.starts_at_0(scales_.idle)) {}

  // One command for each rotor, valid until the next call. delta_out_max [1] limits the change of
  // each command since the previous call, if it is positive. In the first call it limits the change
  // from 0; without a deadband it does not limit the first call.
  std::span<const Scalar> mix(const Controls& controls, Scalar delta_out_max,
                              Saturation& saturation) {
    Controls c = stages_.scaled(controls, scales_);
    Scalar min_out = 1, max_out = 0;
    for (const Rotor& rotor : rotors_) {
      const Scalar out = stages_.without_yaw(rotor, c, 1) + c.thrust;
      if (out < min_out) min_out = out;
      if (out > max_out) max_out = out;
    }
    const MixerFit<Scalar> fit = stages_.fit(min_out, max_out, c.thrust);
    saturation = stages_.saturation(min_out, max_out);
    saturation.yaw = stages_.yield_yaw(rotors_, c, fit);
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      const Scalar wanted = stages_.command(rotors_[i], c, fit, scales_.idle);
      commands_[i] = has_previous_ ? stages_.slew(wanted, commands_[i], delta_out_max) : wanted;
    }
    has_previous_ = true;
    return std::span<const Scalar>(commands_).first(rotors_.size());
  }

  std::span<const Rotor> rotors() const { return rotors_; }

 private:
  std::span<const Rotor> rotors_;
  MixerScales<Scalar> scales_;
  [[no_unique_address]] Stages stages_;
  std::array<Scalar, rotors_max> commands_{};
  // Whether delta_out_max limits the next call's change from `commands_`, which start at 0.
  bool has_previous_;
};

using Mixer = BasicMixer<float>;

}  // namespace attest::actuation
