// The points of a sweep's samples in the unit cube, which has a dimension for each dispersion
// except seeds.
//
// The point of a sample depends on the design, the seed and the index of the sample only. So each
// machine can make the points of any samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/sweep/sample_stream.hpp"

namespace attest {

enum class DesignKind {
  monte_carlo,      // independent random points
  latin_hypercube,  // in each dimension one sample in each of `samples` strata of equal probability
  sobol,            // Joe and Kuo's direction numbers (2008), with a random digital shift
  grid,             // all combinations of levels, each in the middle of its stratum
  saltelli,         // blocks for Sobol indices, of independent random points
};
std::string_view name_of(DesignKind kind);
Result<DesignKind> parse_design(std::string_view name);  // the error lists them all

struct Design {
  DesignKind kind = DesignKind::monte_carlo;
  std::uint64_t samples = 0;
  std::size_t dimensions = 0;
  std::vector<std::uint64_t> levels;  // grid: of each dimension; their product is `samples`
  // Gaussian copula: the correlation matrix of the dimensions' normal scores, row by row. Empty:
  // the dimensions are independent.
  std::vector<double> correlation;

  // The number of samples in a block of `saltelli` (Saltelli et al., Variance based sensitivity
  // analysis of model output, 2010). A block has two independent points A and B, and then a mixed
  // point for each dimension. A mixed point has the number of B in its dimension, and those of A in
  // all others.
  std::uint64_t block() const { return dimensions + 2; }
  // Whether requirements and sign tests use the sample. They leave out the mixed points of
  // `saltelli`, which are not independent of A and B.
  bool is_judged(std::uint64_t index) const {
    return kind != DesignKind::saltelli || index % block() < 2;
  }
  // The sample whose drawn seeds this sample has. A mixed point of `saltelli` has those of A, any
  // other sample has its own.
  std::uint64_t with_seeds(std::uint64_t index) const {
    return is_judged(index) ? index : index - index % block();
  }
};

inline constexpr std::size_t most_dimensions = 1000;

// Errors: the correlation matrix is not positive definite. REQUIRES: a symmetric matrix of
// dimensions x dimensions with ones on the diagonal, or none.
Result<void> check_correlation(const Design& design);

class DesignPoints {
 public:
  // REQUIRES: check_correlation() succeeds.
  DesignPoints(Design design, SampleStream stream);
  ~DesignPoints();

  // One number in (0, 1) for each dimension. REQUIRES: index < samples.
  std::vector<double> at(std::uint64_t index) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// A permutation of 0 to count - 1 that can be evaluated at one place: a generalised Feistel cipher
// (Black and Rogaway, Ciphers with Arbitrary Finite Domains, 2002). `key` selects it. REQUIRES:
// index < count.
std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key,
                       const SampleStream& stream);

}  // namespace attest
