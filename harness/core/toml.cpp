#include "harness/core/toml.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "harness/core/file.hpp"
#include "harness/core/printable.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/core/toml_depth.hpp"
#include "harness/core/toml_names.hpp"

namespace attest {
namespace {

struct Place {
  int line = 1;
  int column = 1;

  friend auto operator<=>(const Place&, const Place&) = default;
};

// toml++ gives line 0 to nodes that it did not read from the text.
Place place_of(const toml::source_region& region) {
  return {std::max(1, static_cast<int>(region.begin.line)),
          std::max(1, static_cast<int>(region.begin.column))};
}

struct Complaint {
  Place place;
  std::string message;

  friend bool operator==(const Complaint&, const Complaint&) = default;
};

using Names = std::set<std::string, std::less<>>;

struct Asked {
  Names read;  // read, or with a recorded error
  Names seen;  // looked at by kind() or has(); has no effect if it is never read
};

TomlKind kind_of(const toml::node& node) {
  if (node.is_table()) return TomlKind::table;
  if (node.is_array()) return TomlKind::array;
  if (node.is_integer()) return TomlKind::integer;
  if (node.is_floating_point()) return TomlKind::number;
  if (node.is_boolean()) return TomlKind::boolean;
  return TomlKind::text;
}

std::string_view found_name(const toml::node& node) {
  const bool is_time = node.is_date() || node.is_time() || node.is_date_time();
  return is_time ? "a date or time without quotes" : name_of(kind_of(node));
}

template <typename T>
std::optional<T> convert(const toml::node& node) {
  return node.value_exact<T>();
}

template <>
std::optional<double> convert<double>(const toml::node& node) {
  if (const auto integer = node.value_exact<std::int64_t>()) return static_cast<double>(*integer);
  return node.value_exact<double>();
}

// Writes a node as JSON, with one text for equal numbers: 5 also for 5.0 and 0x5. The text of a
// number can be read back to the bit. toml++ sorts the keys of its tables.
void write_canonical(const toml::node& node, std::ostream& out) {
  if (const toml::table* const table = node.as_table()) {
    out << '{';
    for (const auto& [key, value] : *table) {
      out << toml::json_formatter(toml::value<std::string>(key.str())) << ':';
      write_canonical(value, out);
      out << ',';
    }
    out << '}';
  } else if (const toml::array* const array = node.as_array()) {
    out << '[';
    for (const toml::node& element : *array) {
      write_canonical(element, out);
      out << ',';
    }
    out << ']';
  } else if (const auto number = node.value_exact<double>()) {
    out << fmt::format("{}", *number);
  } else {
    out << toml::json_formatter(node);
  }
}

}  // namespace

struct TomlFile::Document {
  std::string name;
  toml::table table;
  std::vector<Complaint> complaints;
  std::map<const toml::table*, Asked> visited;

  void complain(Place place, const std::string& message) {
    const Complaint complaint{place, printable_part(message)};
    // If a key is read twice, its error is recorded once.
    const auto same = std::find(complaints.begin(), complaints.end(), complaint);
    if (same == complaints.end()) complaints.push_back(complaint);
  }

  std::vector<Complaint> unread_keys() const;
};

std::vector<Complaint> TomlFile::Document::unread_keys() const {
  std::vector<Complaint> unread;
  for (const auto& [node, asked] : visited) {
    std::vector<std::string> known(asked.read.begin(), asked.read.end());
    known.insert(known.end(), asked.seen.begin(), asked.seen.end());
    for (const auto& [key, value] : *node) {
      if (asked.read.contains(key.str())) continue;
      const std::string message =
          asked.seen.contains(key.str())
              ? fmt::format("key `{}` has no effect here; remove it", key.str())
              : fmt::format("unknown key `{}`{}", key.str(), suggestion(key.str(), known));
      unread.push_back({place_of(key.source()), printable_part(message)});
    }
  }
  return unread;
}

struct TomlTable::Impl {
  std::shared_ptr<TomlFile::Document> document;
  const toml::table* node;  // null: the table is missing or no table; the error is recorded
  Place place;

  const toml::node* find(std::string_view key) const { return node ? node->get(key) : nullptr; }

  Place place_of_key(std::string_view key) const {
    if (!node) return place;
    const auto found = node->find(key);
    return found == node->end() ? place : place_of(found->first.source());
  }

  void mark_read(std::string_view key) const {
    if (node) document->visited[node].read.emplace(key);
  }

  const toml::node* read(std::string_view key) const {
    mark_read(key);
    return find(key);
  }

  void mismatch(Place where, const std::string& what, std::string_view need,
                const toml::node& found) const {
    const std::string message =
        fmt::format("{} must be {}, found {}", what, need, found_name(found));
    document->complain(where, message);
  }

  void mismatch(std::string_view key, std::string_view need, const toml::node& found) const {
    mismatch(place_of_key(key), fmt::format("`{}`", key), need, found);
  }

  // Null if the key is absent; this is an error, unless the table itself is missing.
  const toml::node* require(std::string_view key, std::string_view need) const {
    const toml::node* value = read(key);
    if (!value && node) {
      document->complain(place, fmt::format("missing key `{}`; it must be {}", key, need));
    }
    return value;
  }

  template <typename T>
  T value_or_complain(std::string_view key, const toml::node& found, T otherwise) const {
    if (std::optional<T> value = convert<T>(found)) return *std::move(value);
    mismatch(key, needed<T>(), found);
    return otherwise;
  }

  template <typename T>
  T required(std::string_view key) const {
    const toml::node* value = require(key, needed<T>());
    return value ? value_or_complain<T>(key, *value, T{}) : T{};
  }

  template <typename T>
  T optional(std::string_view key, T fallback) const {
    const toml::node* value = read(key);
    return value ? value_or_complain<T>(key, *value, std::move(fallback)) : fallback;
  }

  template <typename T>
  std::vector<T> list(std::string_view key) const;
};

template <typename T>
std::vector<T> TomlTable::Impl::list(std::string_view key) const {
  std::vector<T> values;
  const toml::node* found = require(key, needed<std::vector<T>>());
  if (!found) return values;
  const toml::array* array = found->as_array();
  if (!array) {
    mismatch(key, needed<std::vector<T>>(), *found);
    return values;
  }
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::node& element = (*array)[i];
    if (std::optional<T> value = convert<T>(element)) {
      values.push_back(*std::move(value));
    } else {
      mismatch(place_of(element.source()), fmt::format("`{}[{}]`", key, i), needed<T>(), element);
    }
  }
  return values;
}

TomlKind TomlTable::kind(std::string_view key) const {
  if (impl_->node) impl_->document->visited[impl_->node].seen.emplace(key);
  const toml::node* node = impl_->find(key);
  return node ? kind_of(*node) : TomlKind::absent;
}

int TomlTable::line(std::string_view key) const {
  const toml::node* node = impl_->find(key);
  return node ? place_of(node->source()).line : 0;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::pair<Place, std::string>> placed;
  if (impl_->node) {
    for (const auto& [key, value] : *impl_->node) {
      placed.emplace_back(place_of(key.source()), std::string(key.str()));
    }
  }
  std::sort(placed.begin(), placed.end());
  std::vector<std::string> names;
  for (auto& [place, name] : placed) names.push_back(std::move(name));
  return names;
}

std::string TomlTable::text(std::string_view key) const {
  return impl_->required<std::string>(key);
}
double TomlTable::number(std::string_view key) const { return impl_->required<double>(key); }
std::int64_t TomlTable::integer(std::string_view key) const {
  return impl_->required<std::int64_t>(key);
}
std::vector<double> TomlTable::numbers(std::string_view key) const {
  return impl_->list<double>(key);
}
std::map<std::string, std::string> TomlTable::text_table(std::string_view key) const {
  std::map<std::string, std::string> texts;
  if (!has(key)) return texts;
  const TomlTable inner = table(key);
  for (const std::string& name : inner.keys()) texts[name] = inner.text(name);
  return texts;
}

std::vector<std::string> TomlTable::texts(std::string_view key) const {
  return impl_->list<std::string>(key);
}
std::vector<std::int64_t> TomlTable::integers(std::string_view key) const {
  return impl_->list<std::int64_t>(key);
}

TomlTable TomlTable::table(std::string_view key) const {
  const toml::node* found = impl_->require(key, needed<TomlTable>());
  const toml::table* table = found ? found->as_table() : nullptr;
  if (found && !table) impl_->mismatch(key, needed<TomlTable>(), *found);
  if (table) impl_->document->visited.try_emplace(table);
  return TomlTable(std::make_shared<Impl>(Impl{impl_->document, table, impl_->place_of_key(key)}));
}

std::string TomlTable::text(std::string_view key, std::string fallback) const {
  return impl_->optional<std::string>(key, std::move(fallback));
}
double TomlTable::number(std::string_view key, double fallback) const {
  return impl_->optional<double>(key, fallback);
}
std::int64_t TomlTable::integer(std::string_view key, std::int64_t fallback) const {
  return impl_->optional<std::int64_t>(key, fallback);
}
bool TomlTable::boolean(std::string_view key, bool fallback) const {
  return impl_->optional<bool>(key, fallback);
}

void TomlTable::error(std::string_view key, const std::string& message) const {
  impl_->mark_read(key);
  impl_->document->complain(impl_->place_of_key(key), message);
}

Result<TomlFile> TomlFile::read(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  return parse(*text, path.string());
}

Result<TomlFile> TomlFile::parse(std::string_view text, const std::string& name) {
  if (auto checked = check_depth(text, name); !checked) return tl::unexpected(checked.error());
  auto document = std::make_shared<Document>(Document{name, {}, {}, {}});
  try {
    document->table = toml::parse(text, std::string_view(name));
  } catch (const toml::parse_error& error) {
    const auto [line, column] = place_of(error.source());
    return fail_at(name, fmt::format("not valid TOML: {}", error.description()), line, column);
  }
  return TomlFile(std::move(document));
}

TomlTable TomlFile::root() const {
  const auto* node = &document_->table;
  return TomlTable(std::make_shared<TomlTable::Impl>(TomlTable::Impl{document_, node, Place{}}));
}

Result<void> TomlFile::finish() const {
  std::vector<Complaint> all = document_->complaints;
  document_->visited.try_emplace(&document_->table);
  for (Complaint& unread : document_->unread_keys()) all.push_back(std::move(unread));
  if (all.empty()) return {};
  std::stable_sort(all.begin(), all.end(),
                   [](const Complaint& a, const Complaint& b) { return a.place < b.place; });
  std::string message = all.front().message;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const auto& [place, text] = all[i];
    message += fmt::format("\n{}:{}:{}: {}", document_->name, place.line, place.column, text);
  }
  return fail_at(document_->name, std::move(message), all.front().place.line,
                 all.front().place.column);
}

std::string TomlFile::canonical(std::span<const std::string_view> without) const {
  toml::table all = document_->table;
  for (const std::string_view path : without) {
    const auto dot = path.find('.');
    toml::table* const table =
        dot == std::string_view::npos ? &all : all[path.substr(0, dot)].as_table();
    if (table) table->erase(path.substr(dot + 1));  // npos + 1 is 0
  }
  std::ostringstream text;
  write_canonical(all, text);
  return std::move(text).str();
}

}  // namespace attest
