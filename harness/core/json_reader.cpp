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

std::string JsonReader::text(const char* key) {
  const json& value = member(key);
  if (value.is_string()) return value.get<std::string>();
  wrong(fmt::format("`{}` is not a string", key));
  return {};
}

std::vector<std::string> JsonReader::texts(const char* key) {
  const json& values = member(key);
  std::vector<std::string> out;
  for (const json& value : values) {
    if (value.is_string()) out.push_back(value.get<std::string>());
  }
  if (!values.is_array() || out.size() != values.size()) {
    wrong(fmt::format("`{}` is not a list of strings", key));
  }
  return out;
}

std::uint64_t JsonReader::count(const char* key) {
  const json& value = member(key);
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  wrong(fmt::format("`{}` is not a count", key));
  return 0;
}

std::int64_t JsonReader::integer(const char* key) {
  const json& value = member(key);
  if (value.is_number_integer()) return value.get<std::int64_t>();
  wrong(fmt::format("`{}` is not an integer", key));
  return 0;
}

bool JsonReader::flag(const char* key) {
  const json& value = member(key);
  if (value.is_boolean()) return value.get<bool>();
  wrong(fmt::format("`{}` is not true or false", key));
  return false;
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
