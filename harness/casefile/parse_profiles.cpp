#include "harness/casefile/parse_profiles.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

using Names = std::vector<std::string>;

constexpr const char* list_key = "profiles";
constexpr const char* since_key = "since";
constexpr const char* until_key = "until";

// Returns the place of `name`, a value of `key`, in `law`: 0 is the newest profile. Empty after an
// error.
std::optional<std::size_t> place_in(const Names& law, const TomlTable& root, const char* key,
                                    const std::string& name) {
  const auto found = std::find(law.begin(), law.end(), name);
  if (found != law.end()) return static_cast<std::size_t>(found - law.begin());
  root.error(key, find_profile(name)
                      ? fmt::format("`{}` is a profile of another law than the folder", name)
                      : fmt::format("`{}` is no profile{}", name,
                                    suggestion(name, known_profile_names())));
  return std::nullopt;
}

// The end of a range. Without the key it is `otherwise`.
std::optional<std::size_t> end_of_range(const Names& law, const TomlTable& root, const char* key,
                                        std::size_t otherwise) {
  if (!root.has(key)) return otherwise;
  const std::string name = root.text(key);
  return root.kind(key) == TomlKind::text ? place_in(law, root, key, name) : std::nullopt;
}

Names parse_range(const TomlTable& root, const std::string& folder) {
  const Names law = profiles_of_law(folder);
  if (law.empty()) {
    const char* const key = root.has(since_key) ? since_key : until_key;
    root.error(key,
               fmt::format("the folder `{}` is no profile that attest knows{}; give `profiles`",
                           folder, suggestion(folder, known_profile_names())));
    return {};
  }
  const auto oldest = end_of_range(law, root, since_key, law.size() - 1);
  const auto newest = end_of_range(law, root, until_key, 0);
  if (!oldest || !newest) return {};
  if (*oldest < *newest) {
    root.error(until_key,
               fmt::format("`{}` is older than `since`, so there is no profile in the range",
                           law[*newest]));
    return {};
  }
  const auto own =
      static_cast<std::size_t>(std::find(law.begin(), law.end(), folder) - law.begin());
  if (own > *oldest || own < *newest) {
    root.error(own > *oldest ? since_key : until_key,
               fmt::format("leaves out `{}`, the profile of the folder", folder));
  }
  const auto begin = law.begin();
  return {begin + static_cast<std::ptrdiff_t>(*newest),
          begin + static_cast<std::ptrdiff_t>(*oldest) + 1};
}

Names parse_list(const TomlTable& root, const std::string& folder) {
  Names law = profiles_of_law(folder);
  if (law.empty()) {
    law = known_profile_names();
    law.insert(law.begin(), folder);
  }
  const Names names = root.texts(list_key);
  if (names.empty()) root.error(list_key, "names no profile");
  std::set<std::size_t> places;
  for (const std::string& name : names) {
    const auto place = place_in(law, root, list_key, name);
    if (place && !places.insert(*place).second) root.error(list_key, "names a profile twice");
  }
  if (!names.empty() && std::find(names.begin(), names.end(), folder) == names.end()) {
    root.error(list_key, fmt::format("leaves out `{}`, the profile of the folder", folder));
  }
  Names sorted;
  for (const std::size_t place : places) sorted.push_back(law[place]);
  return sorted;
}

}  // namespace

Names parse_profiles(const TomlTable& root, const std::string& folder) {
  const bool is_range = root.has(since_key) || root.has(until_key);
  if (is_range && root.has(list_key))
    root.error(list_key, "`since` or `until` is given too; keep one");
  if (!is_range && !root.has(list_key)) {
    root.error(list_key,
               "missing key `profiles`; list the profiles of the case, or give the oldest of "
               "them as `since`");
    return {folder};
  }
  Names names = is_range ? parse_range(root, folder) : parse_list(root, folder);
  std::erase(names, folder);
  names.insert(names.begin(), folder);
  return names;
}

}  // namespace attest
