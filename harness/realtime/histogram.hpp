// How long something took, a million times: counts in bins of equal ratio, and what is exact.
#pragma once

#include <cstdint>
#include <memory>

#include "harness/core/time.hpp"

namespace attest {

// Percentiles are right to 1%, the width of a bin; count, min, max, mean and the count over the
// limit are exact. Times below 1 ns count as 1 ns, those beyond 1000 s only in what is exact. No
// allocation after construction.
class Histogram {
 public:
  // Counts apart what is above `limit`.
  explicit Histogram(Nanoseconds limit = Nanoseconds::max());
  Histogram(Histogram&&) noexcept;
  Histogram& operator=(Histogram&&) noexcept;
  ~Histogram();

  void add(Nanoseconds time);

  std::uint64_t count() const { return count_; }
  std::uint64_t over_limit() const { return over_limit_; }

  // 0 when nothing was added.
  Nanoseconds min() const { return count_ ? min_ : Nanoseconds(0); }
  Nanoseconds max() const { return max_; }
  Nanoseconds mean() const;

  // The time that `part` (0..1) of all do not exceed.
  Nanoseconds percentile(double part) const;

 private:
  struct Bins;
  std::unique_ptr<Bins> bins_;
  Nanoseconds limit_;
  std::uint64_t count_ = 0, over_limit_ = 0;
  Nanoseconds min_ = Nanoseconds::max(), max_{0}, sum_{0};
};

}  // namespace attest
