#include "harness/core/toml_document.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "harness/core/toml_depth.hpp"

namespace attest {
namespace {

struct Path {
  std::vector<std::string> tables;
  std::string key;
  std::optional<std::size_t> index;
};

Path parse_path(const std::string& text) {
  Path path;
  std::size_t begin = 0;
  for (std::size_t end = text.find('.'); end != std::string::npos; end = text.find('.', begin)) {
    path.tables.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  path.key = text.substr(begin);
  const std::size_t bracket = path.key.rfind('[');
  if (bracket == std::string::npos || !path.key.ends_with(']')) return path;
  std::size_t index = 0;
  const char* const last = path.key.data() + path.key.size() - 1;
  const auto [stop, code] = std::from_chars(path.key.data() + bracket + 1, last, index);
  if (code != std::errc() || stop != last) return path;
  path.index = index;
  path.key.resize(bracket);
  return path;
}

// The table that holds the last key of the path. If a table of the path is missing, it is made if
// `make` is set; otherwise the result is null. Errors: a value on the way is not a table.
Result<toml::table*> find_table(toml::table& root, const Path& path, bool make) {
  toml::table* table = &root;
  for (const std::string& name : path.tables) {
    toml::node* node = table->get(name);
    if (node == nullptr) {
      if (!make) return nullptr;
      node = &table->emplace<toml::table>(name).first->second;
    }
    table = node->as_table();
    if (table == nullptr) return fail(fmt::format("`{}` is no table", name));
  }
  return table;
}

// If the table has a key that itself ends in brackets, such as "q[1]", the path means this key.
void prefer_literal_key(const toml::table& table, Path& path) {
  if (!path.index) return;
  const std::string literal = fmt::format("{}[{}]", path.key, *path.index);
  if (!table.contains(literal)) return;
  path.key = literal;
  path.index.reset();
}

// The number's node; null if there is no such key. Errors: the value is not a number; the path has
// an index, and there is no such array or element.
Result<toml::node*> find_number(toml::table& table, const Path& path) {
  toml::node* node = table.get(path.key);
  if (path.index) {
    toml::array* const array = node ? node->as_array() : nullptr;
    if (array == nullptr) return fail(fmt::format("`{}` is no array", path.key));
    if (*path.index >= array->size()) {
      return fail(fmt::format("`{}` has {} elements; the first is [0]", path.key, array->size()));
    }
    node = array->get(*path.index);
  }
  if (node != nullptr && !node->is_number()) {
    return fail(
        fmt::format("`{}` is no number; name a number in it, or give a number there", path.key));
  }
  return node;
}

template <typename T>
void put(toml::table& table, const Path& path, T value) {
  if (path.index) {
    toml::array& array = *table.get_as<toml::array>(path.key);
    array.insert(array.erase(array.cbegin() + static_cast<std::ptrdiff_t>(*path.index)), value);
  } else {
    table.insert_or_assign(path.key, value);
  }
}

Result<void> set_number(toml::table& root, const std::string& text, double value) {
  constexpr double whole_below = 0x1p53;
  Path path = parse_path(text);
  const auto table = find_table(root, path, true);
  if (!table) return tl::unexpected(table.error());
  prefer_literal_key(**table, path);
  if (const auto node = find_number(**table, path); !node) return tl::unexpected(node.error());
  const bool is_negative_zero = value == 0 && std::signbit(value);  // no integer has this sign
  if (value == std::floor(value) && std::abs(value) < whole_below && !is_negative_zero) {
    put(**table, path, static_cast<std::int64_t>(value));
  } else {
    put(**table, path, value);
  }
  return {};
}

// The key as it is written in a file: with quotes if it needs them.
std::string written_key(const std::string& key) {
  std::ostringstream text;
  text << toml::toml_formatter(toml::table{{key, 0}});
  const std::string assignment = std::move(text).str();
  return assignment.substr(0, assignment.rfind(" = "));
}

// The keys of `table` in the order of `original`, the same table in the parsed file (null if the
// table is new). New keys come last.
std::vector<std::string> keys_in_order(const toml::table& table, const toml::table* original) {
  using LineAndColumn = std::pair<toml::source_index, toml::source_index>;
  constexpr toml::source_index behind_all = std::numeric_limits<toml::source_index>::max();
  std::vector<std::pair<LineAndColumn, std::string>> keys;
  for (const auto& [key, node] : table) {
    const toml::node* const there = original ? original->get(key.str()) : nullptr;
    const auto begin = there ? there->source().begin : toml::source_position{behind_all, 0};
    keys.push_back({{begin.line, begin.column}, std::string(key.str())});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::string> names;
  for (auto& [place, name] : keys) names.push_back(std::move(name));
  return names;
}

bool holds_tables(const toml::table& table) {
  return std::any_of(table.begin(), table.end(),
                     [](const auto& entry) { return entry.second.is_table(); });
}

// Writes each key itself, because the formatter of toml++ would sort the keys of a table. The order
// of metrics and rotors matters.
void write_table(const toml::table& table, const toml::table* original, const std::string& path,
                 std::ostream& out) {
  std::vector<std::pair<std::string, const toml::table*>> inner;
  for (const std::string& key : keys_in_order(table, original)) {
    const toml::node* const node = table.get(key);
    if (const toml::table* const part = node->as_table();
        part && (!part->is_inline() || holds_tables(*part))) {
      inner.emplace_back(key, part);
    } else {
      toml::table one;
      one.insert(key, *node);
      out << toml::toml_formatter(one) << '\n';
    }
  }
  for (const auto& [key, part] : inner) {
    const std::string name = path.empty() ? written_key(key) : path + "." + written_key(key);
    out << '[' << name << "]\n";
    write_table(*part, original ? original->get_as<toml::table>(key) : nullptr, name, out);
  }
}

}  // namespace

struct TomlDocument::Impl {
  toml::table root;
};

Result<TomlDocument> TomlDocument::parse(std::string_view text, const std::string& name) {
  if (auto checked = check_depth(text, name); !checked) return tl::unexpected(checked.error());
  try {
    return TomlDocument(std::make_shared<const Impl>(Impl{toml::parse(text, name)}));
  } catch (const toml::parse_error& error) {
    return fail_at(name, fmt::format("not valid TOML: {}", error.description()),
                   static_cast<int>(error.source().begin.line),
                   static_cast<int>(error.source().begin.column));
  }
}

Result<std::optional<double>> TomlDocument::number(const std::string& path) const {
  toml::table copy = impl_->root;
  Path parsed = parse_path(path);
  const auto table = find_table(copy, parsed, false);
  if (!table) return tl::unexpected(table.error());
  if (*table == nullptr) return std::nullopt;
  prefer_literal_key(**table, parsed);
  const auto node = find_number(**table, parsed);
  if (!node) return tl::unexpected(node.error());
  return *node ? (*node)->value<double>() : std::nullopt;
}

Result<std::string> TomlDocument::with(const Replacements& replacements) const {
  toml::table copy = impl_->root;
  for (const auto& [path, value] : replacements) {
    if (auto set = set_number(copy, path, value); !set) return tl::unexpected(set.error());
  }
  std::ostringstream text;
  write_table(copy, &impl_->root, "", text);
  return std::move(text).str();
}

}  // namespace attest
