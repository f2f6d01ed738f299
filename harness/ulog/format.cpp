#include "harness/ulog/format.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"

namespace attest::ulog {
namespace {

// In the order of Type.
constexpr std::string_view type_names[] = {"int8_t",   "uint8_t", "int16_t",  "uint16_t", "int32_t",
                                           "uint32_t", "int64_t", "uint64_t", "float",    "double",
                                           "bool",     "char",    ""};
constexpr std::uint32_t type_bytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8, 1, 1, 0};

// Splits "q[3]" into "q" and 3, and "q" into "q" and 1. If the brackets have no number, the number
// is empty.
std::pair<std::string_view, std::optional<std::uint32_t>> split_brackets(std::string_view text) {
  const auto open = text.rfind('[');
  if (open == text.npos || !text.ends_with(']')) return {text, 1};
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size() - 1;
  const auto [stop, error] = std::from_chars(text.data() + open + 1, end, number);
  if (error != std::errc{} || stop != end) return {text.substr(0, open), std::nullopt};
  return {text.substr(0, open), number};
}

}  // namespace

std::string_view name_of(Type type) { return type_names[static_cast<std::size_t>(type)]; }
std::uint32_t bytes_of(Type type) { return type_bytes[static_cast<std::size_t>(type)]; }

Result<Field> parse_field(std::string_view text) {
  constexpr std::size_t most_characters = 512;  // so that paths stay short
  const auto space = text.find(' ');
  const std::string_view name = space == text.npos ? "" : text.substr(space + 1);
  const auto [type_name, count] = split_brackets(text.substr(0, space));
  if (type_name.empty() || type_name.find_first_of("[]") != text.npos || name.empty() ||
      name.find(' ') != text.npos || !count || text.size() > most_characters) {
    return fail(fmt::format("`{}` is not a type and a name, as in `float[4] q`",
                            text.substr(0, most_characters)));
  }
  int type = 0;
  while (type < static_cast<int>(Type::nested) && type_names[type] != type_name) ++type;
  const bool is_array = type_name.size() < space;
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
      if (field->count == 0) {
        return fail(fmt::format("format {}: the field {} is empty", format.name, field->name));
      }
      format.fields.push_back(*std::move(field));
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (format.fields.empty()) return fail(fmt::format("format {} has no fields", format.name));
  return &formats_.emplace(format.name, format).first->second;
}

// A format that contains itself reaches the limit of the depth.
Result<const Format*> Formats::measure(std::string_view name, int depth_left) {
  const auto found = formats_.find(name);
  if (found == formats_.end()) return fail(fmt::format("format {} is not defined", name));
  Format& format = found->second;
  if (format.bytes > 0) return &format;
  if (depth_left == 0) return fail(fmt::format("{} is nested too deeply, or in itself", name));
  std::vector<Field> leaves;
  std::uint32_t offset = 0;
  for (const Field& field : format.fields) {
    const bool is_nested = field.type == Type::nested;
    const auto inner = is_nested ? measure(field.type_name, depth_left - 1) : nullptr;
    if (!inner) return inner;
    const std::uint32_t bytes = is_nested ? (*inner)->bytes : bytes_of(field.type);
    if (offset + std::uint64_t{bytes} * field.count > most_bytes) {
      return fail(fmt::format("format {} is too large", name));
    }
    if (!is_nested && !field.is_padding()) leaves.push_back(field.at(field.name, offset));
    for (std::uint32_t i = 0; is_nested && !field.is_padding() && i < field.count; ++i) {
      const std::string prefix = field.name + (field.is_array ? fmt::format("[{}].", i) : ".");
      for (const Field& leaf : (*inner)->leaves) {
        leaves.push_back(leaf.at(prefix + leaf.name, offset + i * bytes + leaf.offset));
      }
      if (leaves.size() > most_leaves) return fail(fmt::format("{} has too many fields", name));
    }
    offset += bytes * field.count;
  }
  format.bytes = offset;
  format.least_bytes =
      leaves.empty() ? 0
                     : leaves.back().offset + leaves.back().count * bytes_of(leaves.back().type);
  format.leaves = std::move(leaves);
  return &format;
}

Result<Field> Format::locate(std::string_view path) const {
  const auto [array, index] = split_brackets(path);
  const bool has_index = array.size() < path.size();
  std::vector<std::string> paths;
  for (const Field& leaf : leaves) {
    const std::uint32_t element = leaf.is_array ? index.value_or(leaf.count) : 0;
    if (leaf.is_array == has_index && leaf.name == array && element < leaf.count) {
      return Field{leaf.type, leaf.type_name, std::string(path),
                   1,         false,          leaf.offset + element * bytes_of(leaf.type)};
    }
    paths.push_back(leaf.name + (leaf.is_array ? fmt::format("[{}]", leaf.count - 1) : ""));
  }
  return fail(fmt::format("{} has no number {}{}", name, path, suggestion(path, paths)));
}

std::string Format::repeated_leaf() const {
  std::set<std::string_view> names;
  for (const Field& leaf : leaves) {
    if (!names.insert(leaf.name).second) return leaf.name;
  }
  return "";
}

}  // namespace attest::ulog
