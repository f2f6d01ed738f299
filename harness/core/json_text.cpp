#include "harness/core/json_text.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace attest {
namespace {

using nlohmann::json;

constexpr auto repair = json::error_handler_t::replace;

struct Wrong {
  std::size_t at;  // the place in the text
  std::string what;
};

tl::unexpected<Error> failure(const Wrong& wrong, std::string_view text, const std::string& file) {
  const std::string_view before = text.substr(0, wrong.at);
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // 0 in the first line
  return fail_at(file, wrong.what, static_cast<int>(lines) + 1,
                 static_cast<int>(wrong.at - line_begin) + 1);
}

// Calls `see` with begin and end of each string, and of each character outside of strings.
// REQUIRES: `text` is JSON.
template <typename See>
void for_each_token(std::string_view text, See see) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t begin = i;
    if (text[i] == '"') {
      for (++i; text[i] != '"'; ++i) i += text[i] == '\\' ? 1 : 0;
    }
    see(begin, i + 1);
  }
}

// The number of members of all objects in `value`. Not recursive, because a port may nest deeply.
std::size_t members_in(const json& value) {
  std::size_t count = 0;
  std::vector<const json*> open{&value};
  while (!open.empty()) {
    const json& next = *open.back();
    open.pop_back();
    count += next.is_object() ? next.size() : 0;
    for (const json& part : next) {
      if (part.is_structured()) open.push_back(&part);
    }
  }
  return count;
}

// `value` keeps the last of two members with one key. REQUIRES: `text` is the JSON of `value`.
bool repeats_a_key(std::string_view text, const json& value) {
  std::size_t keys = 0;
  for_each_token(text, [&](std::size_t i, std::size_t) { keys += text[i] == ':' ? 1 : 0; });
  return keys != members_in(value);
}

// REQUIRES: repeats_a_key(). Keys that are equal only after their escapes are replaced have no
// place.
Wrong repeated_key(std::string_view text) {
  std::vector<std::set<std::string_view>> objects;
  std::string_view last;  // string, with its quotes
  std::optional<std::string_view> repeated;
  for_each_token(text, [&](std::size_t begin, std::size_t end) {
    if (text[begin] == '"') last = text.substr(begin, end - begin);
    if (text[begin] == '{') objects.emplace_back();
    if (text[begin] == '}') objects.pop_back();
    if (text[begin] != ':' || repeated) return;
    if (!objects.back().insert(last).second) repeated = last;
  });
  if (!repeated) return {0, "has a key twice in one object"};
  const std::string_view name = repeated->substr(1, repeated->size() - 2);
  return {static_cast<std::size_t>(repeated->data() - text.data()),
          fmt::format("has `{}` twice in one object", name)};
}

}  // namespace

Result<json> parse_json(std::string_view text, const std::string& file) {
  try {
    json value = json::parse(text);
    if (repeats_a_key(text, value)) return failure(repeated_key(text), text, file);
    return value;
  } catch (const json::parse_error& error) {
    const std::size_t at = error.byte == 0 ? 0 : error.byte - 1;
    if (at < text.size()) return failure({at, "is not JSON from here on"}, text, file);
    return failure({text.size(), "ends inside of the JSON: it is empty or was cut off"}, text,
                   file);
  } catch (const json::exception&) {
    return fail_at(file, "has a number that is too large");
  }
}

nlohmann::json json_from(std::string_view text) {
  return nlohmann::json::parse(text, nullptr, false);
}

nlohmann::ordered_json ordered_json_from(std::string_view text) {
  return nlohmann::ordered_json::parse(text, nullptr, false);
}

std::string text_of(const nlohmann::json& value) { return value.dump(-1, ' ', false, repair); }

std::string document_of(const nlohmann::ordered_json& value) {
  return value.dump(2, ' ', false, repair) + "\n";
}

}  // namespace attest
