// The distributions of dispersed values, as quantile functions of Boost.Math.
//
// The distributions of the C++ standard library are not used: their values differ between
// implementations.
#pragma once

#include <string_view>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

struct Distribution {
  enum class Kind { uniform, normal, log_normal, truncated_normal, choice, seed };
  Kind kind = Kind::uniform;
  double low = 0, high = 0;        // uniform, truncated_normal
  double mean = 0, deviation = 0;  // of normal; of truncated_normal before the truncation
  double median = 0, spread = 0;   // log_normal: ln(value) has the deviation ln(1 + spread)
  std::vector<double> values;      // choice: each with the same probability
};

std::string_view name_of(Distribution::Kind kind);
Result<Distribution::Kind> parse_distribution(std::string_view name);  // the error lists them all

// The value with the cumulative probability `u`. REQUIRES: 0 < u < 1; a kind other than seed, which
// has no quantiles.
double quantile(const Distribution& distribution, double u);

// The standard normal distribution.
double normal_quantile(double u);
double normal_probability(double z);

}  // namespace attest
