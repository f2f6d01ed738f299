#include "harness/ulog/format.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"

namespace attest::ulog {
namespace {

struct TypeTraits {
  std::string_view name;
  std::uint32_t bytes;
};

// In the order of Type.
constexpr TypeTraits type_traits[] = {
    {"int8_t", 1},   {"uint8_t", 1}, {"int16_t", 2},  {"uint16_t", 2}, {"int32_t", 4},
    {"uint32_t", 4}, {"int64_t", 8}, {"uint64_t", 8}, {"float", 4},    {"double", 8},
    {"bool", 1},     {"char", 1},    {"", 0}};

// Splits "q[3]" into "q" and 3. The number is 1 without brackets, and missing if they have none.
struct Bracketed {
  std::string_view name;
  bool has_brackets;
  std::optional<std::uint32_t> number;
};

Bracketed split_brackets(std::string_view text) {
  const auto open = text.rfind('[');
  if (open == text.npos || !text.ends_with(']')) return {text, false, 1};
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size() - 1;
  const auto [stop, error] = std::from_chars(text.data() + open + 1, end, number);
  if (error != std::errc{} || stop != end) return {text.substr(0, open), true, std::nullopt};
  return {text.substr(0, open), true, number};
}

}  // namespace

std::string_view name_of(Type type) { return type_traits[static_cast<std::size_t>(type)].name; }
std::uint32_t bytes_of(Type type) { return type_traits[static_cast<std::size_t>(type)].bytes; }

Result<Field> parse_field(std::string_view text) {
  constexpr std::size_t most_characters = 512;  // so that paths stay short
  const auto space = text.find(' ');
  const std::string_view name = space == text.npos ? "" : text.substr(space + 1);
  const auto [type_name, is_array, count] = split_brackets(text.substr(0, space));
  if (type_name.empty() || type_name.find_first_of("[]") != text.npos || name.empty() ||
      name.find(' ') != text.npos || count.value_or(0) == 0 || text.size() > most_characters) {
    return fail(fmt::format("`{}` is not a type and a name, as in `float[4] q`",
                            text.substr(0, most_characters)));
  }
  int type = 0;
  while (type < static_cast<int>(Type::nested) && type_traits[type].name != type_name) ++type;
  return Field{static_cast<Type>(type), std::string(type_name), std::string(name), *count,
               is_array};
}

Result<const Format*> Formats::add(std::string_view definition) {
  const auto colon = definition.find(':');
  if (colon == 0 || colon == definition.npos) return fail("not a format, as in `name:type field;`");
  std::string_view rest = definition.substr(colon + 1);
  Format format{std::string(definition.substr(0, colon)), std::string(rest), {}};
  if (const auto known = formats_.find(format.name); known != formats_.end()) {
    if (known->second.text == format.text) return &known->second;
    return fail(fmt::format("format {} is defined twice; the first one is used", format.name));
  }
  while (!rest.empty()) {
    const auto end = std::min(rest.find(';'), rest.size());
    if (end > 0) {
      auto field = parse_field(rest.substr(0, end));
      if (!field) return fail(fmt::format("format {}: {}", format.name, field.error().message));
      format.fields.push_back(*std::move(field));
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (format.fields.empty()) return fail(fmt::format("format {} has no fields", format.name));
  return &formats_.emplace(format.name, format).first->second;
}

// A format in itself reaches the limit of the depth.
Result<const Format*> Formats::measure(std::string_view name, int depth_left) {
  const auto found = formats_.find(name);
  if (found == formats_.end()) return fail(fmt::format("format {} is not defined", name));
  Format& format = found->second;
  if (format.bytes > 0) return &format;
  const auto refused = [&](std::string_view why) {
    return fail(fmt::format("format {} {}", name, why));
  };
  if (depth_left == 0) return refused("is nested too deeply, or in itself");
  std::vector<Field> leaves;
  std::uint32_t offset = 0;
  for (const Field& field : format.fields) {
    Result<const Format*> inner = nullptr;
    if (field.type == Type::nested) inner = measure(field.type_name, depth_left - 1);
    if (!inner) return inner;
    const std::uint32_t bytes = *inner ? (*inner)->bytes : bytes_of(field.type);
    if (offset + std::uint64_t{bytes} * field.count > most_bytes) return refused("is too large");
    if (!*inner && !field.is_padding()) {
      leaves.push_back(field);
      leaves.back().offset = offset;
    }
    for (std::uint32_t i = 0; *inner && !field.is_padding() && i < field.count; ++i) {
      const std::string prefix = field.name + (field.is_array ? fmt::format("[{}].", i) : ".");
      for (Field leaf : (*inner)->leaves) {
        leaf.name.insert(0, prefix);
        leaf.offset += offset + i * bytes;
        leaves.push_back(std::move(leaf));
      }
      if (leaves.size() > most_leaves) return refused("has too many fields");
    }
    offset += bytes * field.count;
  }
  format.leaves = std::move(leaves);
  format.bytes = offset;
  for (const Field& leaf : format.leaves) {
    format.least_bytes = leaf.offset + leaf.count * bytes_of(leaf.type);
  }
  return &format;
}

Result<Field> Format::locate(std::string_view path) const {
  const auto [array, has_brackets, index] = split_brackets(path);
  std::vector<std::string> paths;
  for (Field leaf : leaves) {
    paths.push_back(leaf.name);
    if (leaf.name != (leaf.is_array ? array : path)) continue;
    if (!leaf.is_array) return leaf;
    if (!has_brackets || index.value_or(leaf.count) >= leaf.count) {
      return fail(fmt::format("{}.{} has the elements [0] to [{}]; name one of them", name,
                              leaf.name, leaf.count - 1));
    }
    leaf.offset += *index * bytes_of(leaf.type);
    return Field{leaf.type, leaf.type_name, std::string(path), 1, false, leaf.offset};
  }
  return fail(fmt::format("{} has no field {}{}", name, path, suggestion(path, paths)));
}

}  // namespace attest::ulog
