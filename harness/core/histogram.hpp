// A histogram of times, with bins of equal ratio: each bin ends at 1.01 times its beginning.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "harness/core/time.hpp"

namespace attest {

// Whether `count` samples support the percentile `part` (0..1): at least ten of them have to lie
// beyond it, so count >= 10 / (1 - part). The number beyond a percentile is binomial: with ten, its
// standard deviation is a third of it. With one, the percentile is the maximum, which is a property
// of the run and not of the distribution. p50 needs 20 samples, p90 100, p99 1,000 and p99.9
// 10,000.
bool supports_percentile(std::uint64_t count, double part);

// Percentiles are correct to 1%, the width of a bin. Count, min, max, mean and over_limit() are
// exact. The bins cover 1 ns to 1000 s. Shorter times are in the bin of 1 ns. A percentile beyond
// 1000 s is the maximum. add() does not allocate.
class Histogram {
 public:
  // Times t with from <= t < to, in whole nanoseconds.
  struct Bucket {
    Nanoseconds from{0}, to{0};
    std::uint64_t count = 0;

    friend bool operator==(const Bucket&, const Bucket&) = default;
  };

  // over_limit() counts the times above `limit`.
  explicit Histogram(Nanoseconds limit = Nanoseconds::max());
  Histogram(Histogram&&) noexcept;
  Histogram& operator=(Histogram&&) noexcept;
  ~Histogram();

  // Adds `count` equal times. Zero times set min() and max() only.
  void add(Nanoseconds time, std::uint64_t count = 1);

  std::uint64_t count() const { return count_; }
  std::uint64_t over_limit() const { return over_limit_; }

  // 0 when empty.
  Nanoseconds min() const { return count_ ? min_ : Nanoseconds(0); }
  Nanoseconds max() const { return max_; }
  Nanoseconds mean() const;

  // The time that the share `part` (0..1) of all times does not exceed. Does not check
  // supports_percentile().
  Nanoseconds percentile(double part) const;

  // The bins that are not empty, ascending. With times below 1 ns, the first bucket begins at the
  // minimum. With times beyond 1000 s, the last bucket ends after the maximum.
  std::vector<Bucket> buckets() const;

 private:
  struct Bins;
  std::unique_ptr<Bins> bins_;
  Nanoseconds limit_;
  std::uint64_t count_ = 0, over_limit_ = 0;
  Nanoseconds min_ = Nanoseconds::max(), max_{0}, sum_{0};
};

}  // namespace attest
