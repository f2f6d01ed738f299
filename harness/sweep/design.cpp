#include "harness/sweep/design.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <boost/random/sobol.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"
#include "harness/sweep/distribution.hpp"

namespace attest {
namespace {

using Purpose = SampleStream::Purpose;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::array<std::pair<DesignKind, std::string_view>, 5> design_names = {{
    {DesignKind::monte_carlo, "monte_carlo"},
    {DesignKind::latin_hypercube, "latin_hypercube"},
    {DesignKind::sobol, "sobol"},
    {DesignKind::grid, "grid"},
    {DesignKind::saltelli, "saltelli"},
}};

Eigen::LLT<Matrix> factorised(const Design& design) {
  const auto size = static_cast<Eigen::Index>(design.dimensions);
  return Eigen::LLT<Matrix>(Eigen::Map<const Matrix>(design.correlation.data(), size, size));
}

double in_stratum(std::uint64_t stratum, std::uint64_t strata, double part) {
  const double u = (static_cast<double>(stratum) + part) / static_cast<double>(strata);
  return std::clamp(u, 0x1p-53, 1 - 0x1p-53);
}

}  // namespace

std::string_view name_of(DesignKind kind) {
  return design_names[static_cast<std::size_t>(kind)].second;
}

Result<DesignKind> parse_design(std::string_view name) {
  std::vector<std::string> known;
  for (const auto& [kind, its_name] : design_names) {
    if (name == its_name) return kind;
    known.emplace_back(its_name);
  }
  return fail(fmt::format("unknown design `{}`{}; there are {}", name, suggestion(name, known),
                          fmt::join(known, ", ")));
}

Result<void> check_correlation(const Design& design) {
  if (design.correlation.empty() || factorised(design).info() == Eigen::Success) return {};
  return fail("the correlation matrix is not positive definite: no random values have it");
}

std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key,
                       const SampleStream& stream) {
  // The cipher permutes 0 to a * b - 1, which is hardly more than `count`. A result of `count` or
  // more is permuted again.
  auto a = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  while (a * a < count) ++a;
  const std::uint64_t b = (count + a - 1) / a;
  constexpr std::uint64_t rounds = 6;
  do {
    std::uint64_t left = index % a, right = index / a;
    for (std::uint64_t round = 0; round < rounds; round += 2) {
      left = (left + stream.bits(Purpose::permutation, right, rounds * key + round) % a) % a;
      right = (right + stream.bits(Purpose::permutation, left, rounds * key + round + 1) % b) % b;
    }
    index = right * a + left;
  } while (index >= count);
  return index;
}

struct DesignPoints::Impl {
  Impl(Design of, SampleStream with) : design(std::move(of)), stream(std::move(with)) {
    if (!design.correlation.empty()) factor = factorised(design).matrixL();
    if (design.kind == DesignKind::sobol) sobol.emplace_back(design.dimensions);
  }

  double random(std::uint64_t index, std::size_t dimension) const {
    return open_uniform(stream.bits(Purpose::point, index, dimension));
  }

  // Point 0 of a Sobol sequence is the origin. Boost leaves it out and begins with point 1.
  std::vector<double> sobol_point(std::uint64_t index) {
    std::vector<double> point;
    if (index > 0) sobol.front().seed(index - 1);
    for (std::size_t i = 0; i < sobol.front().dimension(); ++i) {
      const std::uint64_t digits = index > 0 ? sobol.front()() : 0;
      point.push_back(open_uniform(digits ^ stream.bits(Purpose::shift, 0, i)));
    }
    return point;
  }

  // A and B are random points, not points of a Sobol sequence. With few blocks, those would have
  // the same leading binary digits, and a Sobol index that is 1 could be estimated as 0.
  std::vector<double> saltelli_point(std::uint64_t index) const {
    const std::uint64_t block = index / design.block(), place = index % design.block();
    std::vector<double> point;
    for (std::size_t i = 0; i < design.dimensions; ++i) {
      const bool is_of_b = place == 1 || place == i + 2;
      point.push_back(random(2 * block + (is_of_b ? 1 : 0), i));
    }
    return point;
  }

  std::vector<double> grid_point(std::uint64_t index) const {
    std::vector<double> point;
    for (const std::uint64_t levels : design.levels) {
      point.push_back(in_stratum(index % levels, levels, 0.5));
      index /= levels;
    }
    return point;
  }

  std::vector<double> independent(std::uint64_t index) {
    if (design.kind == DesignKind::sobol) return sobol_point(index);
    if (design.kind == DesignKind::saltelli) return saltelli_point(index);
    if (design.kind == DesignKind::grid) return grid_point(index);
    std::vector<double> point;
    for (std::size_t i = 0; i < design.dimensions; ++i) {
      const double u = random(index, i);
      const bool is_stratified = design.kind == DesignKind::latin_hypercube;
      point.push_back(
          is_stratified ? in_stratum(permuted(index, design.samples, i, stream), design.samples, u)
                        : u);
    }
    return point;
  }

  void correlate(std::vector<double>& point) const {
    const Eigen::Index size = factor.rows();
    Eigen::VectorXd scores(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      scores[i] = normal_quantile(point[static_cast<std::size_t>(i)]);
    }
    for (Eigen::Index i = 0; i < size; ++i) {
      double score = 0;  // in a fixed order, so that all compilers give the same bits
      for (Eigen::Index j = 0; j <= i; ++j) score += factor(i, j) * scores[j];
      point[static_cast<std::size_t>(i)] =
          std::clamp(normal_probability(score), 0x1p-53, 1 - 0x1p-53);
    }
  }

  Design design;
  SampleStream stream;
  Matrix factor;
  std::vector<boost::random::sobol> sobol;  // one element for the design `sobol`, otherwise empty
};

DesignPoints::DesignPoints(Design design, SampleStream stream)
    : impl_(std::make_unique<Impl>(std::move(design), std::move(stream))) {}
DesignPoints::~DesignPoints() = default;

std::vector<double> DesignPoints::at(std::uint64_t index) const {
  std::vector<double> point = impl_->independent(index);
  if (impl_->factor.size() > 0) impl_->correlate(point);
  return point;
}

}  // namespace attest
