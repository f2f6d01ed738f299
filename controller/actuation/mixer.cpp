#include "controller/actuation/mixer.hpp"

#include <algorithm>
#include <charconv>

namespace attest::actuation {
namespace {

// Removes the next word from `text` and returns it; an empty word at the end.
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

tl::expected<MixerDefinition, std::string> parse_mixer(std::string_view text) {
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
  if (!(values[3] >= 0 && values[3] < 1)) {
    return tl::unexpected<std::string>("mixer: the deadband must be from 0 to 9999");
  }
  const std::string_view rest = next_word(text);
  if (!rest.empty()) {
    return tl::unexpected("mixer: unexpected '" + std::string(rest) +
                          "' after the deadband: remove it");
  }
  return MixerDefinition{*rotors, values[0], values[1], values[2], -1.0f + 2.0f * values[3]};
}

}  // namespace attest::actuation
