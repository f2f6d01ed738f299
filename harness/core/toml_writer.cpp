#include <sstream>

#include <toml++/toml.h>

#include "harness/core/toml.hpp"

namespace attest {
namespace {

template <typename T>
toml::array array_of(const std::vector<T>& values) {
  toml::array array;
  for (const T& value : values) array.push_back(value);
  return array;
}

}  // namespace

struct TomlWriter::Impl {
  toml::table root;
  toml::table& at(std::string_view table) { return table.empty() ? root : in(root, table); }
  static toml::table& in(toml::table& outer, std::string_view table) {
    return *outer.emplace<toml::table>(table).first->second.as_table();
  }
};

TomlWriter::TomlWriter() : impl_(std::make_unique<Impl>()) {}
TomlWriter::~TomlWriter() = default;

void TomlWriter::set(std::string_view table, std::string_view key, std::string_view value) {
  impl_->at(table).insert_or_assign(key, std::string(value));
}
void TomlWriter::set(std::string_view table, std::string_view key, double value) {
  impl_->at(table).insert_or_assign(key, value);
}
void TomlWriter::set(std::string_view table, std::string_view key, std::int64_t value) {
  impl_->at(table).insert_or_assign(key, value);
}
void TomlWriter::set(std::string_view table, std::string_view key,
                     const std::vector<std::string>& values) {
  impl_->at(table).insert_or_assign(key, array_of(values));
}
void TomlWriter::set(std::string_view table, std::string_view key,
                     const std::vector<double>& values) {
  impl_->at(table).insert_or_assign(key, array_of(values));
}
void TomlWriter::set(std::string_view table, std::string_view key,
                     const std::vector<std::int64_t>& values) {
  impl_->at(table).insert_or_assign(key, array_of(values));
}
void TomlWriter::set(std::string_view table, std::string_view inner, std::string_view key,
                     std::string_view value) {
  Impl::in(impl_->at(table), inner).insert_or_assign(key, std::string(value));
}
void TomlWriter::set(std::string_view table, std::string_view inner, std::string_view key,
                     const std::vector<double>& values) {
  Impl::in(impl_->at(table), inner).insert_or_assign(key, array_of(values));
}

std::string TomlWriter::to_string() const {
  std::ostringstream text;
  text << toml::toml_formatter(impl_->root) << '\n';
  return std::move(text).str();
}

}  // namespace attest
