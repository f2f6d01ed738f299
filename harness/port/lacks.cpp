#include "harness/port/lacks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"
#include "harness/port/port.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

constexpr std::string_view output_prefix = "out/";

// Whether the text is the pattern, in which each `*` stands for any text. Takes the shortest text
// for each `*`, which finds a match if there is one.
bool matches(std::string_view pattern, std::string_view text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  text.remove_prefix(star);
  pattern.remove_prefix(star + 1);
  while (true) {
    const std::size_t next = pattern.find('*');
    if (next == std::string_view::npos) return text.ends_with(pattern);
    const std::size_t found = text.find(pattern.substr(0, next));
    if (found == std::string_view::npos) return false;
    text.remove_prefix(found + next);
    pattern.remove_prefix(next + 1);
  }
}

// Whether the word, with or without out/, is the name or the topic of the output.
bool names(std::string_view word, const Channel& output) {
  if (word.starts_with(output_prefix)) word.remove_prefix(output_prefix.size());
  return matches(word, output.name.substr(output_prefix.size())) || matches(word, output.topic());
}

ChannelSet outputs_named(std::string_view word) {
  ChannelSet named;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (channel.is_output() && names(word, channel)) named.set(i);
  }
  return named;
}

std::vector<std::string> known_parameters() {
  std::vector<std::string> known;
  for (const ModuleInfo& info : modules()) {
    const std::vector<std::string> more = parameter_names(info.module, "");
    known.insert(known.end(), more.begin(), more.end());
  }
  return known;
}

Result<void> add_constant(const std::string& word, Lacks& lacks) {
  const auto constant = parse_parameter(word);
  if (!constant) return fail(fmt::format("`{}`: {}", word, constant.error().message));
  const auto known = known_parameters();
  if (std::ranges::find(known, constant->name) == known.end()) {
    return fail(fmt::format("`{}`: no profile has a parameter `{}`{}", word, constant->name,
                            suggestion(constant->name, known)));
  }
  const ConstantParameter* const other = lacks.constant(constant->name);
  if (other && other->value != constant->value) {
    return fail(fmt::format("`{}` contradicts {}={}", word, other->name, other->value));
  }
  lacks.constants.push_back({constant->name, constant->value});
  return {};
}

Result<void> add(const std::string& word, Lacks& lacks) {
  if (word.find('=') != std::string::npos) return add_constant(word, lacks);
  if (const auto feature = feature_named(word)) {
    lacks.features |= only(*feature);
    return {};
  }
  const ChannelSet outputs = outputs_named(word);
  lacks.outputs |= outputs;
  if (outputs.any()) return {};
  std::vector<std::string> known = names_of(FeatureSet().set());
  for (const Channel& channel : channels()) {
    if (!channel.is_output()) continue;
    known.emplace_back(channel.topic());
    known.emplace_back(channel.name.substr(output_prefix.size()));
  }
  const auto parameters = known_parameters();
  const bool is_parameter = std::ranges::find(parameters, word) != parameters.end();
  return fail(
      fmt::format("`{}` is no feature and no output{}; `attest list --features` and "
                  "`--channels` show them",
                  word,
                  is_parameter ? "; write the value of a constant parameter: " + word + "=1"
                               : suggestion(word, known)));
}

}  // namespace

const ConstantParameter* Lacks::constant(std::string_view parameter) const {
  const auto found = std::ranges::find(constants, parameter, &ConstantParameter::name);
  return found == constants.end() ? nullptr : &*found;
}

Result<Lacks> Lacks::parse(std::span<const std::string> words) {
  constexpr std::size_t most_words = 1000;
  if (words.size() > most_words) return fail(fmt::format("more than {} words", most_words));
  Lacks lacks;
  for (const std::string& word : words) {
    if (const std::string wrong = wrong_in_name(word); !wrong.empty()) {
      return fail("a word " + wrong);
    }
    if (auto added = add(word, lacks); !added) return tl::unexpected(added.error());
    lacks.words.push_back(word);
  }
  return lacks;
}

std::string text_of(std::span<const ParameterChange> parameters, std::string_view separator) {
  std::vector<std::string> texts;
  for (const ParameterChange& one : parameters) {
    texts.push_back(fmt::format("{}={}", one.name, one.value));
  }
  return fmt::format("{}", fmt::join(texts, separator));
}

Result<ParameterChange> parse_parameter(const std::string& text) {
  const auto equals = std::min(text.find('='), text.size());
  const char* const end = text.data() + text.size();
  float value = 0;
  const auto [rest, error] = std::from_chars(std::min(text.data() + equals + 1, end), end, value);
  if (equals == text.size() || error != std::errc{} || rest != end || !std::isfinite(value)) {
    return fail("write NAME=VALUE with a finite number, such as MC_ROLL_P=6.5");
  }
  return ParameterChange{0, text.substr(0, equals), value};
}

}  // namespace attest
