// Statistics that are valid after every sample, so that a sweep may end because of their values.
//
// Take two likelihoods of the samples: one if the probability is uniformly distributed on 0..1, one
// if it has a fixed value. If that value is the true probability, the ratio of the first likelihood
// to the second is a martingale (Robbins, Statistical methods related to the law of the iterated
// logarithm, 1970). Let `level` be between 0 and 1. The probability that the ratio exceeds
// 1 / level after any sample is at most `level` (Ville's inequality, 1939). An interval of Clopper
// and Pearson has no such guarantee.
#pragma once

#include <cstdint>

#include "harness/sweep/statistics.hpp"

namespace attest {

// The logarithm of that ratio, if `held` of `count` samples hold. `probability` is the fixed value.
// REQUIRES: 0 < probability < 1.
double log_mixture_ratio(std::uint64_t held, std::uint64_t count, double probability);

// True if sequential_interval() does not contain the probability.
bool excludes(std::uint64_t held, std::uint64_t count, double probability, double confidence);

// With this confidence, the intervals after 1, 2, 3, ... samples all contain the true probability.
Interval sequential_interval(std::uint64_t held, std::uint64_t count, double confidence);

// The p-value of a two-sided sign test that is valid after every sample. If both signs are equally
// likely, the probability that one of the p-values after 1, 2, 3, ... samples is at most `level` is
// itself at most `level`.
double sequential_sign_test(std::uint64_t positive, std::uint64_t negative);

}  // namespace attest
