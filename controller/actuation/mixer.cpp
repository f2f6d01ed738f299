#include "controller/actuation/mixer.hpp"

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <cmath>

#include "controller/actuation/mixer_geometry.hpp"

namespace attest::actuation {
namespace {

// Thrust may be raised to 1.5 times, or lowered to 0.6 times, what was asked for roll and pitch.
constexpr float thrust_raise = 1.5f;
constexpr float thrust_lower = 0.6f;

// Thrust that one rotor may give up so that yaw keeps authority.
constexpr float thrust_for_yaw_max = 0.15f;

// Lets NaN through, as both comparisons fail.
float clamp(float value, float low, float high) {
  return value < low ? low : (value > high ? high : value);
}

float without_yaw(const Rotor& rotor, const Controls& c, float roll_pitch_scale) {
  return (c.roll * rotor.roll + c.pitch * rotor.pitch) * roll_pitch_scale;
}

// The next word of `text`, which is consumed; empty at the end.
std::string_view next_word(std::string_view& text) {
  constexpr std::string_view blank = " \t\r\n";
  const std::size_t start = std::min(text.find_first_not_of(blank), text.size());
  const std::size_t end = std::min(text.find_first_of(blank, start), text.size());
  const std::string_view word = text.substr(start, end - start);
  text.remove_prefix(end);
  return word;
}

tl::expected<float, std::string> parse_scale(std::string_view word, std::string_view what) {
  int value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end) {
    return tl::unexpected("mixer: " + std::string(what) + " must be an integer in 1/10000, not '" +
                          std::string(word) + "'");
  }
  return static_cast<float>(value) / 10000.0f;
}

tl::expected<std::span<const Rotor>, std::string> find_rotors(std::string_view name) {
  std::string known;
  for (const MixerGeometry& geometry : mixer_geometries()) {
    if (geometry.name == name) return geometry.rotors;
    known.append(" ").append(geometry.name);
  }
  return tl::unexpected("mixer: unknown geometry '" + std::string(name) + "', known are" + known);
}

}  // namespace

tl::expected<Mixer, std::string> Mixer::parse(std::string_view text) {
  if (next_word(text) != "R:") {
    return tl::unexpected<std::string>(
        "mixer: expected 'R: <geometry> <roll> <pitch> <yaw> <deadband>'");
  }
  const auto rotors = find_rotors(next_word(text));
  if (!rotors) return tl::unexpected(rotors.error());
  constexpr std::array<std::string_view, 4> fields{"roll", "pitch", "yaw", "deadband"};
  std::array<float, 4> values{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto value = parse_scale(next_word(text), fields[i]);
    if (!value) return tl::unexpected(value.error());
    values[i] = *value;
  }
  const std::string_view rest = next_word(text);
  if (!rest.empty()) {
    return tl::unexpected("mixer: nothing may follow the deadband, found '" + std::string(rest) +
                          "'");
  }
  return Mixer(*rotors, {values[0], values[1], values[2], -1.0f + 2.0f * values[3]});
}

std::span<const float> Mixer::mix(const Controls& controls, float delta_out_max,
                                  Saturation& saturation) {
  Controls c = scaled(controls);
  float min_out = 1.0f;
  float max_out = 0.0f;
  for (const Rotor& rotor : rotors_) {
    const float out = without_yaw(rotor, c, 1.0f) + c.thrust;
    if (out < min_out) min_out = out;
    if (out > max_out) max_out = out;
  }
  const Fit fitted = fit(min_out, max_out, c.thrust);
  saturation.lower = min_out < 0.0f;
  saturation.upper = max_out > 1.0f;
  saturation.yaw = yield_yaw(c, fitted);
  for (std::size_t i = 0; i < rotors_.size(); ++i) {
    commands_[i] = slew(command(rotors_[i], c, fitted), commands_[i], delta_out_max);
  }
  return std::span<const float>(commands_).first(rotors_.size());
}

Controls Mixer::scaled(const Controls& controls) const {
  return {clamp(controls.roll * scales_.roll, -1.0f, 1.0f),
          clamp(controls.pitch * scales_.pitch, -1.0f, 1.0f),
          clamp(controls.yaw * scales_.yaw, -1.0f, 1.0f), clamp(controls.thrust, 0.0f, 1.0f)};
}

// min_out and max_out are of all rotors, without yaw.
Mixer::Fit Mixer::fit(float min_out, float max_out, float thrust) {
  const float up = thrust * thrust_raise - thrust;
  const float down = thrust - thrust * thrust_lower;
  const auto boosted_from_below = [=](float boost) {
    return Fit{boost, (thrust + boost) / (thrust - min_out)};
  };
  const auto boosted_from_above = [=](float boost) {
    return Fit{boost, (1.0f - (thrust + boost)) / (max_out - thrust)};
  };
  const bool below = min_out < 0.0f;
  const bool above = max_out > 1.0f;
  if (below && max_out < 1.0f) {
    if (-min_out <= 1.0f - max_out) {
      return up >= -min_out ? Fit{-min_out, 1.0f} : boosted_from_below(up);
    }
    return boosted_from_below(clamp(-min_out - (1.0f - max_out) / 2.0f, 0.0f, up));
  }
  if (above && min_out > 0.0f) {
    if (min_out >= max_out - 1.0f) {
      return down >= max_out - 1.0f ? Fit{-(max_out - 1.0f), 1.0f} : boosted_from_above(-down);
    }
    return boosted_from_above(clamp(-(max_out - 1.0f - min_out) / 2.0f, -down, 0.0f));
  }
  if (below && above) {
    return boosted_from_below(clamp(-(max_out - 1.0f + min_out) / 2.0f,
                                    thrust_lower * thrust - thrust,
                                    thrust_raise * thrust - thrust));
  }
  return {};
}

// Cuts yaw, and at the upper limit some thrust, until every rotor is inside its limits; what one
// rotor gave up stays given up for the next. Returns whether yaw was cut.
bool Mixer::yield_yaw(Controls& c, const Fit& fit) const {
  bool cut = false;
  for (const Rotor& rotor : rotors_) {
    const float roll_pitch = without_yaw(rotor, c, fit.roll_pitch_scale);
    const float out = roll_pitch + c.yaw * rotor.yaw + c.thrust + fit.boost;
    const bool has_yaw = std::abs(rotor.yaw) > FLT_EPSILON;
    if (out < 0.0f) {
      c.yaw = has_yaw ? -(roll_pitch + c.thrust + fit.boost) / rotor.yaw : 0.0f;
      cut = true;
    } else if (out > 1.0f) {
      c.thrust -= std::fmin(thrust_for_yaw_max, out - 1.0f);
      c.yaw = has_yaw ? (1.0f - (roll_pitch + c.thrust + fit.boost)) / rotor.yaw : 0.0f;
      cut = true;
    }
  }
  return cut;
}

float Mixer::command(const Rotor& rotor, const Controls& c, const Fit& fit) const {
  const float out =
      without_yaw(rotor, c, fit.roll_pitch_scale) + c.yaw * rotor.yaw + c.thrust + fit.boost;
  return clamp(scales_.idle + out * (1.0f - scales_.idle), scales_.idle, 1.0f);
}

float Mixer::slew(float wanted, float previous, float delta_out_max) {
  if (!(delta_out_max > 0.0f)) return wanted;
  const float delta = wanted - previous;
  if (delta > delta_out_max) return previous + delta_out_max;
  if (delta < -delta_out_max) return previous - delta_out_max;
  return wanted;
}

}  // namespace attest::actuation
