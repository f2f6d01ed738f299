// Reads the members of a JSON object. Reads on after an error and keeps the first message, so that
// a function can read all members of an object and look for an error once at its end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace attest {

class JsonReader {
 public:
  // `error` receives the first error message, unless it is not empty already. REQUIRES: `object`
  // and `error` outlive this.
  JsonReader(const nlohmann::json& object, std::string& error);

  bool has(const char* key) const;

  // A missing member is an error; the result is then null.
  const nlohmann::json& member(const char* key);
  // Error messages of the result name its members as "key.member".
  JsonReader object(const char* key);

  // A member that is missing or of another type is an error; the result is then empty, 0 or false.
  const nlohmann::json& list(const char* key);
  std::string text(const char* key);
  std::vector<std::string> texts(const char* key);
  std::uint64_t count(const char* key, std::uint64_t most = UINT64_MAX);
  std::int64_t integer(const char* key, std::int64_t least = INT64_MIN,
                       std::int64_t most = INT64_MAX);  // below `least`, above `most`: an error
  bool flag(const char* key);
  double real(const char* key);  // accepts the texts "nan", "inf" and "-inf", too

  void wrong(std::string message);
  void wrong(const char* key, const std::string& what);  // "`key` is not a string"

 private:
  template <typename T>
  T typed(const char* key, bool (nlohmann::json::*is_of_type)() const noexcept, const char* what);

  const nlohmann::json& object_;
  std::string& error_;
  std::string path_ = {};  // "key." of an object in an object
};

// JSON has no NaN and no infinity: they are the texts "nan", "inf" and "-inf".
nlohmann::json json_of(double value);
std::optional<double> real_from(const nlohmann::json& value);  // the inverse; else nothing

}  // namespace attest
