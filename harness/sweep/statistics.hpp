// The statistics of a sweep.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace attest {

struct Interval {
  double low = 0, high = 1;
};

// The interval of Clopper and Pearson (1934) for the probability of an event that happened `held`
// times of `count`. It contains the probability with at least this confidence. Without samples it
// is 0 to 1.
Interval clopper_pearson(std::uint64_t held, std::uint64_t count, double confidence);

// The smallest value that at least `part` of the values do not exceed (type 1 of Hyndman and Fan,
// 1996). REQUIRES: sorted, without NaN, not empty; 0 <= part <= 1.
double empirical_quantile(const std::vector<double>& sorted, double part);

// The same; empty if fewer than ten values are beyond the quantile (supports_percentile()).
std::optional<double> supported_quantile(const std::vector<double>& sorted, double part);

// Spearman's rank correlation. Equal values have their mean rank. Pairs with a NaN are left out.
// The result is NaN if fewer than three pairs are left, or all values of `x` or all of `y` are
// equal.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

// The exact two-sided sign test (Dixon and Mood, 1946): the probability of a split at least as
// unequal, if both signs are equally likely. 1 if both counts are 0.
double sign_test(std::uint64_t positive, std::uint64_t negative);

}  // namespace attest
