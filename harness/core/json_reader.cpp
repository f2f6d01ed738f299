#include "harness/core/json_reader.hpp"

#include <cmath>
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
  wrong(fmt::format("`{}` is missing", key));
  return nothing;
}

template <typename T>
T JsonReader::typed(const char* key, bool (json::*is_of_type)() const noexcept, const char* what) {
  const json& value = member(key);
  if ((value.*is_of_type)()) return value.get<T>();
  wrong(fmt::format("`{}` is not {}", key, what));
  return T{};
}

std::string JsonReader::text(const char* key) {
  return typed<std::string>(key, &json::is_string, "a string");
}

std::uint64_t JsonReader::count(const char* key) {
  return typed<std::uint64_t>(key, &json::is_number_unsigned, "a count");
}

std::int64_t JsonReader::integer(const char* key) {
  return typed<std::int64_t>(key, &json::is_number_integer, "an integer");
}

bool JsonReader::flag(const char* key) {
  return typed<bool>(key, &json::is_boolean, "true or false");
}

const json& JsonReader::list(const char* key) {
  static const json empty = json::array();
  const json& values = member(key);
  if (values.is_array()) return values;
  wrong(fmt::format("`{}` is not a list", key));
  return empty;
}

std::vector<std::string> JsonReader::texts(const char* key) {
  std::vector<std::string> out;
  for (const json& value : list(key)) {
    if (!value.is_string()) wrong(fmt::format("`{}` is not a list of strings", key));
    out.push_back(value.is_string() ? value.get<std::string>() : "");
  }
  return out;
}

double JsonReader::real(const char* key) {
  const json& value = member(key);
  if (value.is_number()) return value.get<double>();
  if (value == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (value == "inf") return std::numeric_limits<double>::infinity();
  if (value == "-inf") return -std::numeric_limits<double>::infinity();
  wrong(fmt::format("`{}` is not a number", key));
  return 0;
}

void JsonReader::wrong(std::string message) {
  if (error_.empty()) error_ = std::move(message);
}

json json_of(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

}  // namespace attest
