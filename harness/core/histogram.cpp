#include "harness/core/histogram.hpp"

#include <algorithm>
#include <cmath>

#include <boost/histogram.hpp>

namespace attest {
namespace {

namespace bh = boost::histogram;

// 12 decades, from 1 ns to 1000 s, at 1% a bin: ln(1e12) / ln(1.01).
constexpr unsigned bins = 2777;
constexpr double lowest_ns = 1, highest_ns = 1e12;

using Axis = bh::axis::regular<double, bh::axis::transform::log>;

// The first whole nanosecond at or after a bin's edge.
Nanoseconds whole(double edge_ns) {
  return Nanoseconds(static_cast<std::int64_t>(std::ceil(edge_ns)));
}

}  // namespace

bool supports_percentile(std::uint64_t count, double part) {
  constexpr double beyond = 10, rounding = 1e-9;
  return static_cast<double>(count) * (1 - part) >= beyond * (1 - rounding);
}

struct Histogram::Bins {
  decltype(bh::make_histogram_with(std::vector<std::uint64_t>(), std::declval<Axis>())) counts =
      bh::make_histogram_with(std::vector<std::uint64_t>(), Axis(bins, lowest_ns, highest_ns));
};

Histogram::Histogram(Nanoseconds limit) : bins_(std::make_unique<Bins>()), limit_(limit) {}
Histogram::Histogram(Histogram&&) noexcept = default;
Histogram& Histogram::operator=(Histogram&&) noexcept = default;
Histogram::~Histogram() = default;

void Histogram::add(Nanoseconds time, std::uint64_t count) {
  bins_->counts(bh::weight(count), std::max(static_cast<double>(time.count()), lowest_ns));
  count_ += count;
  over_limit_ += time > limit_ ? count : 0;
  min_ = std::min(min_, time);
  max_ = std::max(max_, time);
  sum_ += time * static_cast<std::int64_t>(count);
}

Nanoseconds Histogram::mean() const {
  return count_ == 0 ? Nanoseconds(0) : sum_ / static_cast<std::int64_t>(count_);
}

Nanoseconds Histogram::percentile(double part) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(part * static_cast<double>(count_)));
  std::uint64_t passed = 0;
  for (auto&& bin : bh::indexed(bins_->counts)) {
    passed += *bin;
    if (passed < wanted) continue;
    const Nanoseconds edge(static_cast<std::int64_t>(bin.bin().upper()));
    return std::clamp(edge, min(), max_);
  }
  return max_;
}

std::vector<Histogram::Bucket> Histogram::buckets() const {
  std::vector<Bucket> filled;
  for (auto&& bin : bh::indexed(bins_->counts, bh::coverage::all)) {
    if (*bin == 0) continue;
    const bool is_beyond = bin.index() == static_cast<int>(bins);
    filled.push_back({whole(is_beyond ? highest_ns : bin.bin().lower()),
                      is_beyond ? max_ + Nanoseconds(1) : whole(bin.bin().upper()), *bin});
  }
  if (!filled.empty()) filled.front().from = std::min(filled.front().from, min());
  return filled;
}

}  // namespace attest
