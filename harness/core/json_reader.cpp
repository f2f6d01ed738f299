#include "harness/core/json_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace attest {

using nlohmann::json;

JsonReader::JsonReader(const json& object, std::string& error) : object_(object), error_(error) {
  if (!object.is_object()) wrong("not an object");
}

bool JsonReader::has(const char* key) const { return object_.is_object() && object_.contains(key); }

const json& JsonReader::member(const char* key) {
  static const json nothing;
  if (has(key)) return object_.at(key);
  wrong(key, "is missing");
  return nothing;
}

JsonReader JsonReader::object(const char* key) {
  const json& value = member(key);
  if (!value.is_object()) wrong(key, "is not an object");
  JsonReader reader(value, error_);
  reader.path_ = fmt::format("{}{}.", path_, key);
  return reader;
}

template <typename T>
T JsonReader::typed(const char* key, bool (json::*is_of_type)() const noexcept, const char* what) {
  const json& value = member(key);
  if ((value.*is_of_type)()) return value.get<T>();
  wrong(key, fmt::format("is not {}", what));
  return T{};
}

std::string JsonReader::text(const char* key) {
  return typed<std::string>(key, &json::is_string, "a string");
}

std::uint64_t JsonReader::count(const char* key, std::uint64_t most) {
  const auto value = typed<std::uint64_t>(key, &json::is_number_unsigned, "a count");
  if (value <= most) return value;
  wrong(key, fmt::format("is {}; it must be at most {}", value, most));
  return 0;
}

std::int64_t JsonReader::integer(const char* key, std::int64_t least, std::int64_t most) {
  const auto value = typed<std::int64_t>(key, &json::is_number_integer, "an integer");
  const json& given = member(key);
  const bool is_larger = given.is_number_unsigned() && given.get<std::uint64_t>() > INT64_MAX;
  if (!is_larger && value >= least && value <= most) return value;
  wrong(key, fmt::format("is {}; it must be from {} to {}", given.dump(), least, most));
  return std::max(least, std::int64_t{0});
}

bool JsonReader::flag(const char* key) {
  return typed<bool>(key, &json::is_boolean, "true or false");
}

const json& JsonReader::list(const char* key) {
  static const json empty = json::array();
  const json& values = member(key);
  if (values.is_array()) return values;
  wrong(key, "is not a list");
  return empty;
}

std::vector<std::string> JsonReader::texts(const char* key) {
  std::vector<std::string> out;
  for (const json& value : list(key)) {
    if (!value.is_string()) wrong(key, "is not a list of strings");
    out.push_back(value.is_string() ? value.get<std::string>() : "");
  }
  return out;
}

double JsonReader::real(const char* key) {
  const auto value = real_from(member(key));
  if (!value) wrong(key, "is not a number");
  return value.value_or(0);
}

void JsonReader::wrong(std::string message) {
  if (error_.empty()) error_ = std::move(message);
}

void JsonReader::wrong(const char* key, const std::string& what) {
  wrong(fmt::format("`{}{}` {}", path_, key, what));
}

json json_of(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

std::optional<double> real_from(const json& value) {
  if (value.is_number()) return value.get<double>();
  if (value == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (value == "inf") return std::numeric_limits<double>::infinity();
  if (value == "-inf") return -std::numeric_limits<double>::infinity();
  return std::nullopt;
}

}  // namespace attest
