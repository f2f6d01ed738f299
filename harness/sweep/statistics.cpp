#include "harness/sweep/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/statistics/bivariate_statistics.hpp>

#include "harness/core/histogram.hpp"
#include "harness/sweep/boost_policy.hpp"

namespace attest {
namespace {

using Binomial = boost::math::binomial_distribution<double, BoostPolicy>;

// Ranks count from 1. Equal values have their mean rank.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);
    for (; begin < end; ++begin) ranks[order[begin]] = rank;
  }
  return ranks;
}

bool all_equal(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
}

}  // namespace

Interval clopper_pearson(std::uint64_t held, std::uint64_t count, double confidence) {
  if (count == 0) return {};
  const auto n = static_cast<double>(count), k = static_cast<double>(held);
  const double each_side = (1 - confidence) / 2;
  return {held == 0 ? 0 : Binomial::find_lower_bound_on_p(n, k, each_side),
          held == count ? 1 : Binomial::find_upper_bound_on_p(n, k, each_side)};
}

double empirical_quantile(const std::vector<double>& sorted, double part) {
  const double rank = std::ceil(part * static_cast<double>(sorted.size()));
  const auto place = static_cast<std::size_t>(std::max(rank, 1.0));
  return sorted[std::min(place, sorted.size()) - 1];
}

std::optional<double> supported_quantile(const std::vector<double>& sorted, double part) {
  if (!supports_percentile(sorted.size(), std::max(part, 1 - part))) return std::nullopt;
  return empirical_quantile(sorted, part);
}

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  constexpr std::size_t fewest = 3;
  std::vector<double> a, b;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i]) || std::isnan(y[i])) continue;
    a.push_back(x[i]);
    b.push_back(y[i]);
  }
  if (a.size() < fewest || all_equal(a) || all_equal(b)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return boost::math::statistics::correlation_coefficient(ranks_of(a), ranks_of(b));
}

double sign_test(std::uint64_t positive, std::uint64_t negative) {
  const auto fewer = static_cast<double>(std::min(positive, negative));
  const auto all = static_cast<double>(positive + negative);
  if (all == 0) return 1;
  return std::min(1.0, 2 * boost::math::cdf(Binomial(all, 0.5), fewer));
}

}  // namespace attest
