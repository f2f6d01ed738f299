#include "harness/suite/select.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fnmatch.h>

#include "harness/casefile/parse.hpp"
#include "harness/core/nearest.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

bool matches(const std::string& pattern, const std::string& text) {
  return ::fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
}

bool matches_any(const std::vector<std::string>& filters, const Case& the_case, const Rate& rate) {
  if (filters.empty()) return true;
  const std::string at_rate = "@" + rate.label();
  const std::string in_group = the_case.group + "/" + the_case.name;
  return std::any_of(filters.begin(), filters.end(), [&](const std::string& pattern) {
    return matches(pattern, the_case.id()) || matches(pattern, the_case.id() + at_rate) ||
           matches(pattern, in_group) || matches(pattern, in_group + at_rate) ||
           matches(pattern, the_case.name);
  });
}

template <typename T>
bool contains(const std::vector<T>& list, const T& item) {
  return list.empty() || std::find(list.begin(), list.end(), item) != list.end();
}

// Each name asked for must exist: a misspelt group would otherwise select nothing, silently.
Result<void> check_names(const std::vector<std::string>& asked, const std::set<std::string>& known,
                         const char* kind) {
  for (const std::string& name : asked) {
    if (known.count(name)) continue;
    const std::vector<std::string> candidates(known.begin(), known.end());
    return fail(fmt::format("no cases of {} `{}`{}; there are {}", kind, name,
                            suggestion(name, candidates), fmt::join(candidates, ", ")));
  }
  return {};
}

// Profile and group are in the path, so that files that cannot match need not be read.
std::string group_of(const fs::path& file) { return file.parent_path().filename().string(); }
std::string profile_of(const fs::path& file) {
  return file.parent_path().parent_path().filename().string();
}

Result<void> check_selection(const std::vector<fs::path>& files, const Selection& selection) {
  std::set<std::string> groups, profiles;
  for (const fs::path& file : files) {
    groups.insert(group_of(file));
    profiles.insert(profile_of(file));
  }
  if (auto known = check_names(selection.groups, groups, "group"); !known) return known;
  return check_names(selection.profiles, profiles, "profile");
}

std::vector<Rate> selected_rates(const Case& the_case, const Selection& selection) {
  std::vector<Rate> rates;
  for (const Rate& rate : the_case.rates) {
    if (contains(selection.rates, rate) && matches_any(selection.filters, the_case, rate)) {
      rates.push_back(rate);
    }
  }
  return rates;
}

// Only some of these: what the case files name, and no rate that none of them has.
Result<void> check_rates(const std::vector<Rate>& asked, const std::set<Rate>& known) {
  for (const Rate& rate : asked) {
    if (known.count(rate)) continue;
    std::vector<std::string> names;
    for (const Rate& other : known) names.push_back(other.to_string());
    return fail(fmt::format("no selected case runs at {} Hz; there are {} Hz", rate.to_string(),
                            fmt::join(names, ", ")));
  }
  return {};
}

std::vector<SelectedCase> part_of(std::vector<SelectedCase> all, const Shard& shard) {
  std::vector<SelectedCase> part;
  for (std::size_t i = shard.index - 1; i < all.size(); i += shard.count) {
    part.push_back(std::move(all[i]));
  }
  return part;
}

}  // namespace

Result<Shard> Shard::parse(const std::string& text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto [slash, bad_index] = std::from_chars(text.data(), end, shard.index);
  if (bad_index == std::errc{} && slash != end && *slash == '/') {
    const auto [rest, bad_count] = std::from_chars(slash + 1, end, shard.count);
    const bool in_range = shard.index >= 1 && shard.index <= shard.count;
    if (bad_count == std::errc{} && rest == end && in_range) return shard;
  }
  return fail(fmt::format("`{}` is not a shard; write I/N with I from 1 to N, such as 2/4", text));
}

Result<std::vector<SelectedCase>> select_cases(const fs::path& folder, const Selection& selection) {
  auto files = find_case_files(folder);
  if (!files) return tl::unexpected(files.error());
  if (auto known = check_selection(*files, selection); !known) {
    return tl::unexpected(known.error());
  }
  std::vector<SelectedCase> selected;
  std::set<Rate> rates;
  for (const fs::path& file : *files) {
    if (!contains(selection.groups, group_of(file))) continue;
    if (!contains(selection.profiles, profile_of(file))) continue;
    auto parsed = parse_case(file);
    if (!parsed) return tl::unexpected(parsed.error());
    rates.insert(parsed->rates.begin(), parsed->rates.end());
    auto chosen = selected_rates(*parsed, selection);
    if (!chosen.empty()) selected.push_back({std::move(*parsed), std::move(chosen)});
  }
  if (auto known = check_rates(selection.rates, rates); !known) {
    return tl::unexpected(known.error());
  }
  if (selected.empty()) {
    return fail(fmt::format("no case matches {}; `attest list` shows them all",
                            selection.filters.empty()
                                ? std::string("the selection")
                                : fmt::format("`{}`", fmt::join(selection.filters, "` or `"))));
  }
  selected = part_of(std::move(selected), selection.shard);
  if (selected.empty()) return fail("this shard is empty: there are more shards than cases");
  return selected;
}

}  // namespace attest
