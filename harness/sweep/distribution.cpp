#include "harness/sweep/distribution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"
#include "harness/sweep/boost_policy.hpp"

namespace attest {
namespace {

using Normal = boost::math::normal_distribution<double, BoostPolicy>;
using Kind = Distribution::Kind;

constexpr std::array<std::pair<Kind, std::string_view>, 6> kind_names = {{
    {Kind::uniform, "uniform"},
    {Kind::normal, "normal"},
    {Kind::log_normal, "log_normal"},
    {Kind::truncated_normal, "truncated_normal"},
    {Kind::choice, "choice"},
    {Kind::seed, "seed"},
}};

double truncated_normal(const Distribution& of, double u) {
  const double below = normal_probability((of.low - of.mean) / of.deviation);
  const double above = normal_probability((of.mean - of.high) / of.deviation);
  // Above the median the value is computed from the probability of the upper tail, which is small
  // and therefore has more digits.
  const double part = 1 - below - above;
  const double from_below = below + u * part;
  const double from_above = above + (1 - u) * part;
  const double z = from_below < 0.5 ? normal_quantile(from_below) : -normal_quantile(from_above);
  return std::clamp(of.mean + of.deviation * z, of.low, of.high);
}

double choice(const std::vector<double>& values, double u) {
  const auto index = static_cast<std::size_t>(u * static_cast<double>(values.size()));
  return values[std::min(index, values.size() - 1)];
}

}  // namespace

std::string_view name_of(Kind kind) { return kind_names[static_cast<std::size_t>(kind)].second; }

Result<Kind> parse_distribution(std::string_view name) {
  std::vector<std::string> known;
  for (const auto& [kind, its_name] : kind_names) {
    if (name == its_name) return kind;
    known.emplace_back(its_name);
  }
  return fail(fmt::format("unknown distribution `{}`{}; there are {}", name,
                          suggestion(name, known), fmt::join(known, ", ")));
}

double normal_quantile(double u) { return boost::math::quantile(Normal(), u); }

double normal_probability(double z) { return boost::math::cdf(Normal(), z); }

double quantile(const Distribution& distribution, double u) {
  switch (distribution.kind) {
    case Kind::uniform:
      return distribution.low + (distribution.high - distribution.low) * u;
    case Kind::normal:
      return distribution.mean + distribution.deviation * normal_quantile(u);
    case Kind::log_normal:
      return distribution.median * std::exp(std::log1p(distribution.spread) * normal_quantile(u));
    case Kind::truncated_normal:
      return truncated_normal(distribution, u);
    case Kind::choice:
      return choice(distribution.values, u);
    case Kind::seed:
      break;
  }
  return std::nan("");
}

}  // namespace attest
