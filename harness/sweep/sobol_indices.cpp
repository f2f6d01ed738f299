#include "harness/sweep/sobol_indices.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "harness/sweep/distribution.hpp"

namespace attest {
namespace {

constexpr std::uint64_t fewest_blocks = 10;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The complete blocks in which all values are finite: of A, of B, and of each mixed point.
class Blocks {
 public:
  Blocks(const std::vector<double>& values, std::size_t size) : values_(values) {
    for (std::size_t begin = 0; begin + size <= values.size(); begin += size) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
      const bool is_finite = std::all_of(first, first + static_cast<std::ptrdiff_t>(size),
                                         [](double value) { return std::isfinite(value); });
      if (is_finite) begins_.push_back(begin);
      if (!is_finite) ++left_out_;
    }
  }

  std::size_t count() const { return begins_.size(); }
  std::uint64_t left_out() const { return left_out_; }
  double a(std::size_t block) const { return values_[begins_[block]]; }
  double b(std::size_t block) const { return values_[begins_[block] + 1]; }
  double mixed(std::size_t block, std::size_t dimension) const {
    return values_[begins_[block] + 2 + dimension];
  }

 private:
  const std::vector<double>& values_;
  std::vector<std::size_t> begins_;
  std::uint64_t left_out_ = 0;
};

// The variance of A and B together. It is the mean of `terms`, one for each block.
struct Variance {
  double mean = 0, value = 0;
  std::vector<double> terms;
};

Variance variance_of(const Blocks& blocks) {
  Variance variance;
  const double first = blocks.a(0);  // subtracted, so that equal values have exactly no variance
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    variance.mean += (blocks.a(i) - first) + (blocks.b(i) - first);
  }
  variance.mean = first + variance.mean / 2 / static_cast<double>(blocks.count());
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    const double a = blocks.a(i) - variance.mean, b = blocks.b(i) - variance.mean;
    variance.terms.push_back((a * a + b * b) / 2);
  }
  variance.value = mean_of(variance.terms);
  return variance;
}

struct Ratio {
  double value = 0;
  Interval interval;
};

// The mean of the terms divided by the variance. The interval is that of the delta method for a
// ratio of two means.
Ratio ratio_of(const std::vector<double>& terms, const Variance& variance, double confidence) {
  const double value = mean_of(terms) / variance.value;
  double squares = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double influence = (terms[i] - value * variance.terms[i]) / variance.value;
    squares += influence * influence;
  }
  const auto count = static_cast<double>(terms.size());
  const double error = std::sqrt(squares / count / (count - 1));
  const double width = normal_quantile((1 + confidence) / 2) * error;
  return {value, {value - width, value + width}};
}

SobolIndex index_of(const Blocks& blocks, std::size_t dimension, const Variance& variance,
                    double confidence) {
  std::vector<double> first, total;
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    const double change = blocks.mixed(i, dimension) - blocks.a(i);
    first.push_back((blocks.b(i) - variance.mean) * change);
    total.push_back(change * change / 2);
  }
  const Ratio of_first = ratio_of(first, variance, confidence);
  const Ratio of_total = ratio_of(total, variance, confidence);
  return {of_first.value, of_total.value, of_first.interval, of_total.interval};
}

}  // namespace

SobolIndices sobol_indices(const std::vector<double>& values, std::size_t dimensions,
                           double confidence) {
  const Blocks blocks(values, dimensions + 2);
  SobolIndices indices;
  indices.blocks = blocks.count();
  indices.left_out = blocks.left_out();
  if (blocks.count() < fewest_blocks) return indices;
  const Variance variance = variance_of(blocks);
  if (!(variance.value > 0)) return indices;
  for (std::size_t i = 0; i < dimensions; ++i) {
    indices.dimensions.push_back(index_of(blocks, i, variance, confidence));
  }
  return indices;
}

}  // namespace attest
