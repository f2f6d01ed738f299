#include "harness/sweep/parse_dispersions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

using Kind = Distribution::Kind;

constexpr std::int64_t most_levels = 1'000'000;

double finite(const TomlTable& table, const std::string& key) {
  const double value = table.number(key);
  if (!std::isfinite(value)) table.error(key, "must be a finite number");
  return value;
}

double above_zero(const TomlTable& table, const std::string& key) {
  const double value = finite(table, key);
  if (table.has(key) && !(value > 0)) table.error(key, "must be positive");
  return value;
}

void parse_limits(const TomlTable& table, Distribution& distribution) {
  distribution.low = finite(table, "low");
  distribution.high = finite(table, "high");
  const bool is_given = table.has("low") && table.has("high");
  if (is_given && !(distribution.low < distribution.high)) {
    table.error("high", "must be above `low`");
  }
}

void parse_choice(const TomlTable& table, Distribution& distribution) {
  distribution.values = table.numbers("values");
  const auto is_finite = [](double value) { return std::isfinite(value); };
  const auto& values = distribution.values;
  if (table.has("values") && values.empty()) table.error("values", "names no value");
  if (!std::all_of(values.begin(), values.end(), is_finite)) {
    table.error("values", "must be finite numbers");
  }
}

// The least part of a normal distribution that a truncation may leave. With less, the values would
// be nearly constant.
constexpr double least_part = 1e-6;

void check_part(const TomlTable& table, const Distribution& of) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  const std::array numbers{of.mean, of.deviation, of.low, of.high};
  const bool are_numbers = std::all_of(numbers.begin(), numbers.end(), is_finite);
  if (!are_numbers || !(of.deviation > 0) || !(of.low < of.high)) return;
  const double part = normal_probability((of.high - of.mean) / of.deviation) -
                      normal_probability((of.low - of.mean) / of.deviation);
  if (!(part >= least_part)) {
    table.error("low", "with `high` it leaves less than a millionth of the normal distribution");
  }
}

Distribution parse_distribution_of(const TomlTable& table) {
  constexpr const char* key = "distribution";
  Distribution distribution;
  const auto kind = parse_distribution(table.text(key));
  if (!kind && table.has(key)) table.error(key, kind.error().message);
  if (!kind) return distribution;
  distribution.kind = *kind;
  switch (*kind) {
    case Kind::uniform:
      parse_limits(table, distribution);
      break;
    case Kind::normal:
    case Kind::truncated_normal:
      distribution.mean = finite(table, "mean");
      distribution.deviation = above_zero(table, "deviation");
      if (*kind == Kind::normal) break;
      parse_limits(table, distribution);
      check_part(table, distribution);
      break;
    case Kind::log_normal:
      distribution.median = above_zero(table, "median");
      distribution.spread = above_zero(table, "spread");
      break;
    case Kind::choice:
      parse_choice(table, distribution);
      break;
    case Kind::seed:
      break;
  }
  return distribution;
}

// "vehicle.mass_kg" or "case.flight.start.tilt_deg".
std::vector<DispersedKey> parse_keys(const TomlTable& table) {
  std::vector<DispersedKey> keys;
  for (const std::string& text : table.texts("keys")) {
    const bool of_vehicle = text.starts_with("vehicle.");
    if (!of_vehicle && !text.starts_with("case.")) {
      table.error("keys", fmt::format("`{}` must begin with `vehicle.` or `case.`", text));
      continue;
    }
    keys.push_back({of_vehicle ? DispersedKey::Document::vehicle : DispersedKey::Document::the_case,
                    text.substr(text.find('.') + 1)});
    if (keys.back().path.empty()) table.error("keys", fmt::format("`{}` names no key", text));
  }
  if (keys.empty() && table.has("keys")) table.error("keys", "names no key");
  return keys;
}

Dispersion::As parse_as(const TomlTable& table, Kind kind) {
  constexpr const char* key = "as";
  if (!table.has(key)) return Dispersion::As::value;
  const std::string as = table.text(key);
  if (kind == Kind::seed) table.error(key, "a seed is a value; leave it out");
  if (as == "factor") return Dispersion::As::factor;
  if (as == "offset") return Dispersion::As::offset;
  if (as != "value") table.error(key, "must be value, factor or offset");
  return Dispersion::As::value;
}

std::uint64_t parse_levels(const TomlTable& table, const Distribution& of, DesignKind design) {
  constexpr const char* key = "levels";
  if (of.kind == Kind::choice) {
    if (table.has(key)) table.error(key, "a choice has a level for each value; leave it out");
    return of.values.size();
  }
  if (design != DesignKind::grid || of.kind == Kind::seed) {
    if (table.has(key)) table.error(key, "is for the design `grid`; leave it out");
    return 0;
  }
  const std::int64_t levels = table.integer(key);
  if (table.has(key) && (levels < 1 || levels > most_levels)) {
    table.error(key, fmt::format("must be from 1 to {}", most_levels));
    return 1;
  }
  return static_cast<std::uint64_t>(levels);
}

// The name of a dispersion is that of a column of samples.csv.
void check_name(const TomlTable& table, const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (name.empty() || name == "sample" || !std::all_of(name.begin(), name.end(), is_plain)) {
    table.error(name, "a name has letters, digits and `_`, and is not `sample`");
  }
}

// The index of the dimension with this name. Without such a dimension: the number of dimensions.
std::size_t dimension_named(const std::string& name, const std::vector<Dispersion>& dispersions) {
  const std::vector<std::size_t> dimensions = dimensions_of(dispersions);
  const auto found = std::find_if(dimensions.begin(), dimensions.end(),
                                  [&](std::size_t i) { return dispersions[i].name == name; });
  return static_cast<std::size_t>(found - dimensions.begin());
}

// The dimensions that one matrix correlates. `taken`: the dimensions that are in a matrix already.
std::vector<std::size_t> parse_members(const TomlTable& table,
                                       const std::vector<Dispersion>& dispersions,
                                       std::set<std::size_t>& taken) {
  constexpr const char* key = "dispersions";
  std::vector<std::size_t> members;
  std::vector<std::string> known;
  for (const std::size_t i : dimensions_of(dispersions)) known.push_back(dispersions[i].name);
  for (const std::string& name : table.texts(key)) {
    const std::size_t dimension = dimension_named(name, dispersions);
    if (dimension == known.size()) {
      table.error(key, fmt::format("no dispersion `{}`{}", name, suggestion(name, known)));
    } else if (!taken.insert(dimension).second) {
      table.error(key, fmt::format("`{}` is correlated twice; give one matrix", name));
    } else {
      members.push_back(dimension);
    }
  }
  return members;
}

bool is_correlation(const std::vector<double>& matrix, std::size_t size) {
  if (matrix.size() != size * size) return false;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      const double value = matrix[i * size + j];
      const bool is_sane = i == j ? value == 1 : std::abs(value) < 1;
      if (!is_sane || value != matrix[j * size + i]) return false;
    }
  }
  return true;
}

void parse_matrix(const TomlTable& table, const std::vector<std::size_t>& members,
                  std::size_t dimensions, std::vector<double>& all) {
  constexpr const char* key = "matrix";
  const std::vector<double> matrix = table.numbers(key);
  const std::size_t size = members.size();
  if (!is_correlation(matrix, size)) {
    if (table.has(key)) {
      table.error(key, fmt::format("needs {} x {} numbers, row by row: 1 on the diagonal, "
                                   "symmetric, between -1 and 1",
                                   size, size));
    }
    return;
  }
  if (!check_correlation({DesignKind::monte_carlo, 1, size, {}, matrix})) {
    table.error(key, "is not positive definite: no random values have these correlations");
  }
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      all[members[i] * dimensions + members[j]] = matrix[i * size + j];
    }
  }
}

}  // namespace

std::vector<std::size_t> dimensions_of(const std::vector<Dispersion>& dispersions) {
  std::vector<std::size_t> dimensions;
  for (std::size_t i = 0; i < dispersions.size(); ++i) {
    if (dispersions[i].distribution.kind != Kind::seed) dimensions.push_back(i);
  }
  return dimensions;
}

std::vector<Dispersion> parse_dispersions(const TomlTable& root, DesignKind design) {
  std::vector<Dispersion> dispersions;
  const TomlTable all = root.table("disperse");
  for (const std::string& name : all.keys()) {
    const TomlTable table = all.table(name);
    check_name(all, name);
    Dispersion dispersion;
    dispersion.name = name;
    dispersion.line = all.line(name);
    dispersion.keys = parse_keys(table);
    dispersion.distribution = parse_distribution_of(table);
    dispersion.as = parse_as(table, dispersion.distribution.kind);
    dispersion.levels = parse_levels(table, dispersion.distribution, design);
    dispersions.push_back(std::move(dispersion));
  }
  const std::size_t dimensions = dimensions_of(dispersions).size();
  if (dimensions > most_dimensions) {
    root.error("disperse", fmt::format("has more than {} dispersions", most_dimensions));
  }
  if (dimensions == 0 && root.has("disperse")) {
    root.error("disperse", "needs at least one dispersion that is not a seed");
  }
  return dispersions;
}

std::vector<double> parse_correlation(const TomlTable& root,
                                      const std::vector<Dispersion>& dispersions,
                                      DesignKind design) {
  if (!root.has("correlate")) return {};
  const std::size_t dimensions = dimensions_of(dispersions).size();
  std::vector<double> all(dimensions * dimensions, 0);
  for (std::size_t i = 0; i < dimensions; ++i) all[i * dimensions + i] = 1;
  const TomlTable tables = root.table("correlate");
  if (design == DesignKind::grid) {
    root.error("correlate", "a grid has all combinations; leave it out");
  }
  if (design == DesignKind::saltelli) {
    root.error("correlate", "Sobol indices need independent dispersions; leave it out");
  }
  std::set<std::size_t> taken;
  for (const std::string& name : tables.keys()) {
    const TomlTable table = tables.table(name);
    const std::vector<std::size_t> members = parse_members(table, dispersions, taken);
    parse_matrix(table, members, dimensions, all);
  }
  return all;
}

}  // namespace attest
