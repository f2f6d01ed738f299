#include "harness/casefile/select.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fnmatch.h>

#include "harness/casefile/parse.hpp"
#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

bool matches(const std::string& pattern, const std::string& text) {
  return ::fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
}

// Whether a pattern matches this vector. All patterns that match it are added to `matching`,
// because a pattern that matches no vector is an error.
bool matches_any(const std::vector<std::string>& filters, const Case& the_case,
                 const RunConfiguration& configuration, std::set<std::string>& matching) {
  if (filters.empty()) return false;
  const std::string in_group = the_case.group + "/" + the_case.name;
  std::vector<std::string> names = {the_case.name};
  for (const std::string& name : {the_case.id(), in_group}) {
    for (const std::string& end :
         {std::string(), "@" + configuration.label(), "@" + configuration.rate.label()}) {
      names.push_back(name + end);
    }
  }
  bool any = false;
  for (const std::string& pattern : filters) {
    if (!std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return matches(pattern, name); })) {
      continue;
    }
    any = true;
    matching.insert(pattern);
  }
  return any;
}

template <typename T>
bool contains(const std::vector<T>& list, const T& item) {
  return list.empty() || std::find(list.begin(), list.end(), item) != list.end();
}

// Each requested name must exist. Otherwise a misspelt group would silently select no case.
Result<void> check_names(const std::vector<std::string>& asked, const std::set<std::string>& known,
                         const char* kind) {
  for (const std::string& name : asked) {
    if (known.count(name)) continue;
    const std::vector<std::string> candidates(known.begin(), known.end());
    if (candidates.empty()) return fail(fmt::format("no selected case has a {}", kind));
    return fail(fmt::format("no cases of {} `{}`{}; there are {}", kind, name,
                            suggestion(name, candidates), fmt::join(candidates, ", ")));
  }
  return {};
}

// The group is taken from the path, so that files that cannot match need not be read.
std::string group_of(const fs::path& file) { return file.parent_path().filename().string(); }

Result<void> keep_groups(const Selection& selection, std::vector<fs::path>& files) {
  if (selection.groups.empty()) return {};
  std::set<std::string> groups;
  for (const fs::path& file : files) groups.insert(group_of(file));
  std::erase_if(files,
                [&](const fs::path& file) { return !contains(selection.groups, group_of(file)); });
  return check_names(selection.groups, groups, "group");
}

// Whether a pattern can match a case of this file. Of `<profile>/<group>/<name>`, only group and
// name are known here, from the path. Take the text from the pattern's last wildcard to its @:
// either the known part must end with this text, or this text with the known part. A wildcard
// without @ may match the @ of a vector and all that follows; [ and \ are not examined.
bool may_match(const std::string& pattern, const fs::path& file) {
  const std::size_t at = pattern.find('@');
  const std::string id = pattern.substr(0, at);
  const std::size_t wildcard = id.find_last_of("*?");
  const bool has_wildcard = wildcard != std::string::npos;
  if (pattern.find_first_of("[\\") != std::string::npos ||
      file.stem().string().find('@') != std::string::npos)
    return true;
  if (has_wildcard && at == std::string::npos) return true;
  const std::string end = has_wildcard ? id.substr(wildcard + 1) : id;
  const std::string known = "/" + group_of(file) + "/" + file.stem().string();
  return known.ends_with(end) || end.ends_with(known);
}

bool may_be_selected(const fs::path& file, const Selection& selection) {
  const auto& filters = selection.filters;
  return filters.empty() || std::any_of(filters.begin(), filters.end(), [&](const auto& pattern) {
           return may_match(pattern, file);
         });
}

// "1000" selects the vectors of one unit at 1000 Hz, and each pair whose rate unit runs at 1000 Hz;
// "250:1000" selects this pair only.
bool is_meant(const LoopRate& asked, const LoopRate& rate) {
  return asked.attitude_unit ? asked == rate : asked.motor_unit == rate.motor_unit;
}

bool has_rate(const RunConfiguration& configuration, const std::vector<LoopRate>& asked) {
  return asked.empty() || std::any_of(asked.begin(), asked.end(), [&](const LoopRate& one) {
           return is_meant(one, configuration.rate);
         });
}

bool is_selected(const RunConfiguration& configuration, const Selection& selection) {
  if (!has_rate(configuration, selection.rates)) return false;
  if (!configuration.plant_configuration)
    return selection.vehicles.empty() && selection.plants.empty();
  return contains(selection.vehicles, configuration.plant_configuration->vehicle) &&
         contains(selection.plants, std::string(name_of(configuration.plant_configuration->plant)));
}

std::vector<RunConfiguration> selected_configurations(const Case& the_case,
                                                      const Selection& selection,
                                                      std::set<std::string>& matching) {
  std::vector<RunConfiguration> configurations = the_case.configurations();
  std::erase_if(configurations, [&](const RunConfiguration& configuration) {
    if (!is_selected(configuration, selection)) return true;
    // Both are evaluated, so that each pattern that matches is recorded.
    const bool is_excluded = matches_any(selection.excludes, the_case, configuration, matching);
    const bool is_meant = selection.filters.empty() ||
                          matches_any(selection.filters, the_case, configuration, matching);
    return is_excluded || !is_meant;
  });
  return configurations;
}

// The rates, profiles, vehicles, plants and names in the files that were read.
struct Known {
  std::set<LoopRate> rates;
  std::set<std::string> profiles, groups, vehicles, plants;
  std::vector<std::string> names;  // "roll_30", "attitude/roll_30", "attitude/*"
  void add(const Case& the_case) {
    const std::string& group = the_case.group;
    names.insert(names.end(), {the_case.name, group + "/" + the_case.name, group + "/*"});
    groups.insert(group);
    profiles.insert(the_case.profiles.begin(), the_case.profiles.end());
    for (const RunConfiguration& configuration : the_case.configurations()) {
      rates.insert(configuration.rate);
      if (!configuration.plant_configuration) continue;
      vehicles.insert(configuration.plant_configuration->vehicle);
      plants.insert(std::string(name_of(configuration.plant_configuration->plant)));
    }
  }
};

// At least one vector in the files must have each requested rate.
Result<void> check_rates(const std::vector<LoopRate>& asked, const std::set<LoopRate>& known) {
  for (const LoopRate& rate : asked) {
    const auto means = [&](const LoopRate& other) { return is_meant(rate, other); };
    if (std::any_of(known.begin(), known.end(), means)) continue;
    std::vector<std::string> names;
    for (const LoopRate& other : known) names.push_back(other.to_string());
    return fail(fmt::format("no selected case runs at {} Hz; there are {} Hz", rate.to_string(),
                            fmt::join(names, ", ")));
  }
  return {};
}

Result<void> check_known(const Selection& selection, const Known& known) {
  auto profiles = check_names(selection.profiles, known.profiles, "profile");
  if (!profiles) return profiles;
  if (auto checked = check_rates(selection.rates, known.rates); !checked) return checked;
  auto vehicles = check_names(selection.vehicles, known.vehicles, "vehicle");
  return vehicles ? check_names(selection.plants, known.plants, "plant") : vehicles;
}

// How long a vector takes [ms], to balance shards. Measured with the reference: an open-loop vector
// takes 1 ms at any rate; a flight takes a time for each second and a time for each tick of the
// loop. With more ticks MuJoCo also makes more steps.
double cost_ms(const Case& the_case, const RunConfiguration& configuration) {
  if (!configuration.plant_configuration) return 1;
  const bool is_mujoco = configuration.plant_configuration->plant == PlantKind::mujoco;
  const double per_second = is_mujoco ? 7 : 1.2, per_tick = is_mujoco ? 0.007 : 0.004;
  const double seconds = the_case.duration.in == Span::In::seconds ? the_case.duration.amount : 5;
  return seconds * (per_second + per_tick * configuration.rate.hertz());
}

double cost_ms(const SelectedCase& selected) {
  double sum = 0;
  for (const RunConfiguration& configuration : selected.configurations) {
    sum += cost_ms(selected.the_case, configuration);
  }
  return sum;
}

// Assigns the cases, longest first, each to the part that is shortest so far (Graham, 1969).
std::vector<SelectedCase> part_of(std::vector<SelectedCase> all, const Shard& shard) {
  if (shard.count == 1) return all;
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> costs;
  for (const SelectedCase& selected : all) costs.push_back(cost_ms(selected));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  std::vector<double> parts(std::min(shard.count, all.size()), 0.0);
  std::vector<std::size_t> chosen;
  for (const std::size_t i : order) {
    const auto shortest = std::min_element(parts.begin(), parts.end());
    *shortest += costs[i];
    const auto part = static_cast<std::size_t>(shortest - parts.begin());
    if (part == shard.index - 1) chosen.push_back(i);
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<SelectedCase> part;
  for (const std::size_t i : chosen) part.push_back(std::move(all[i]));
  return part;
}

void add_selected(const Case& parsed, const Selection& selection, std::set<std::string>& matching,
                  std::vector<SelectedCase>& selected) {
  for (const std::string& profile : parsed.profiles) {
    if (!contains(selection.profiles, profile)) continue;
    Case the_case = parsed.in_profile(profile);
    auto configurations = selected_configurations(the_case, selection, matching);
    if (!configurations.empty())
      selected.push_back({std::move(the_case), std::move(configurations)});
  }
}

// " with --group attitude, --rate 250": the options that select in addition to the patterns.
std::string scope_of(const Selection& selection) {
  std::vector<std::string> rates;
  for (const LoopRate& rate : selection.rates) rates.push_back(rate.to_string());
  const auto options = as_options({{"--group", selection.groups},
                                   {"--profile", selection.profiles},
                                   {"--rate", rates},
                                   {"--vehicle", selection.vehicles},
                                   {"--plant", selection.plants}});
  return options.empty() ? "" : fmt::format(" with {}", fmt::join(options, ", "));
}

// Each pattern must match a vector. Otherwise a misspelt filter would silently leave out vectors,
// and a misspelt exclusion would run vectors that should be left out.
Result<void> check_patterns(const Selection& selection, const std::set<std::string>& matching,
                            const Known& known) {
  std::vector<std::string> idle;
  for (const auto& patterns : {selection.filters, selection.excludes}) {
    for (const std::string& pattern : patterns) {
      if (!matching.contains(pattern)) idle.push_back(pattern);
    }
  }
  if (idle.empty()) return {};
  if (known.groups.contains(idle.front())) {
    return fail(fmt::format("`{0}` is a group: write `--group {0}` or `{0}/*`", idle.front()));
  }
  return fail(fmt::format("no case{} matches `{}`{}; `attest list` shows them all",
                          scope_of(selection), fmt::join(idle, "` or `"),
                          suggestion(idle.front(), known.names)));
}

Result<std::vector<SelectedCase>> select_from(const std::vector<fs::path>& files,
                                              const Selection& selection) {
  std::vector<SelectedCase> selected;
  Known known;
  std::set<std::string> matching;  // filters and exclusions that match a vector
  for (const fs::path& file : files) {
    auto parsed = parse_case(file);
    if (!parsed) return tl::unexpected(parsed.error());
    known.add(*parsed);
    add_selected(*parsed, selection, matching, selected);
  }
  if (auto checked = check_known(selection, known); !checked) {
    return tl::unexpected(checked.error());
  }
  if (auto checked = check_patterns(selection, matching, known); !checked) {
    return tl::unexpected(checked.error());
  }
  if (selected.empty()) {
    return fail("no case matches the selection; `attest list` shows them all");
  }
  std::sort(selected.begin(), selected.end(), [](const SelectedCase& a, const SelectedCase& b) {
    return a.the_case.id() < b.the_case.id();
  });
  const auto twin = std::adjacent_find(selected.begin(), selected.end(),
                                       [](const SelectedCase& a, const SelectedCase& b) {
                                         return a.the_case.id() == b.the_case.id();
                                       });
  if (twin != selected.end()) {
    return fail_at(twin->the_case.file.string(),
                   fmt::format("is {}, and so is {}; give one of them another name",
                               twin->the_case.id(), std::next(twin)->the_case.file.string()));
  }
  selected = part_of(std::move(selected), selection.shard);
  if (selected.empty()) return fail("this shard is empty: there are more shards than cases");
  return selected;
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

std::string Shard::to_string() const { return fmt::format("{}/{}", index, count); }

std::vector<SelectedCase> keep_vectors(std::vector<SelectedCase> cases,
                                       const std::set<std::string>& ids) {
  for (auto& [the_case, configurations] : cases) {
    std::erase_if(configurations, [&, &one = the_case](const RunConfiguration& configuration) {
      return !ids.contains(one.id_at(configuration));
    });
  }
  std::erase_if(cases, [](const SelectedCase& one) { return one.configurations.empty(); });
  return cases;
}

std::vector<std::string> as_options(
    std::initializer_list<std::pair<const char*, const std::vector<std::string>&>> lists) {
  std::vector<std::string> options;
  for (const auto& [option, values] : lists) {
    if (!values.empty()) options.push_back(fmt::format("{} {}", option, fmt::join(values, ",")));
  }
  return options;
}

Result<std::vector<SelectedCase>> select_cases(const CaseFolders& folders,
                                               const Selection& selection) {
  auto files = find_case_files(folders);
  if (!files) return tl::unexpected(files.error());
  if (auto known = keep_groups(selection, *files); !known) return tl::unexpected(known.error());
  // Only files that a pattern can match are read first. If this gives an error, all files of the
  // groups are read, because the error message lists what they contain.
  std::vector<fs::path> likely = *files;
  std::erase_if(likely, [&](const fs::path& file) { return !may_be_selected(file, selection); });
  auto selected = select_from(likely, selection);
  return selected || likely.size() == files->size() ? selected : select_from(*files, selection);
}

}  // namespace attest
