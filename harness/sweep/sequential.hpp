// Statistics that stay valid when one looks after each sample, and stops because of what one sees.
//
// The ratio of the likelihoods of a mixture of all probabilities (uniform) and of one probability
// is a martingale under the latter (Robbins, Statistical methods related to the law of the iterated
// logarithm, 1970). So it ever exceeds 1 / a with at most the probability a (Ville's inequality,
// 1939). An interval of Clopper and Pearson has no such guarantee.
#pragma once

#include <cstdint>

#include "harness/sweep/statistics.hpp"

namespace attest {

// The logarithm of that ratio. REQUIRES: 0 < probability < 1.
double log_mixture_ratio(std::uint64_t held, std::uint64_t count, double probability);

// True if the interval below does not contain the probability.
bool excludes(std::uint64_t held, std::uint64_t count, double probability, double confidence);

// With this confidence, the intervals after 1, 2, 3, ... samples all contain the probability.
Interval sequential_interval(std::uint64_t held, std::uint64_t count, double confidence);

// The two-sided sign test for any time of stopping: the p-values after 1, 2, 3, ... samples ever
// fall to a with at most the probability a, if both signs are equally likely.
double sequential_sign_test(std::uint64_t positive, std::uint64_t negative);

}  // namespace attest
