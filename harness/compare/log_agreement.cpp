#include "harness/compare/log_agreement.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "harness/core/agreement.hpp"

namespace attest {
namespace {

struct Topic {
  std::string_view name;
  const Channel* published = nullptr;
  std::vector<std::size_t> fields;  // indices into channels()

  bool is_in(const Sample& sample) const { return value_of(*published, sample) != 0; }
};

std::vector<Topic> topics_in(const ChannelSet& present) {
  std::vector<Topic> topics;
  const auto table = channels();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!present[i] || !table[i].is_output()) continue;
    const std::string_view name = table[i].topic();
    if (topics.empty() || topics.back().name != name) topics.push_back({name, nullptr, {}});
    if (table[i].is_published_flag())
      topics.back().published = &table[i];
    else
      topics.back().fields.push_back(i);
  }
  std::erase_if(topics, [](const Topic& topic) {
    return topic.published == nullptr || topic.fields.empty();
  });
  return topics;
}

// The successive samples of a trace: those that are kept of the parts before, then the last part.
class Samples {
 public:
  // REQUIRES: `part` stays where it is up to keep_last().
  void add(const Trace& part) { part_ = part.samples; }
  // Keeps the last two samples or fewer, because the part ends.
  void keep_last() {
    const auto last = part_.last(std::min<std::size_t>(part_.size(), 2));
    kept_.insert(kept_.end(), last.begin(), last.end());
    kept_.erase(kept_.begin(), kept_.end() - std::min<std::ptrdiff_t>(std::ssize(kept_), 2));
    part_ = {};
  }
  std::size_t size() const { return kept_.size() + part_.size(); }
  const Sample& operator[](std::size_t at) const {
    return at < kept_.size() ? kept_[at] : part_[at - kept_.size()];
  }

 private:
  std::vector<Sample> kept_;
  std::span<const Sample> part_;
};

// The range of the reference's finite values of a field at a tick and its neighbours.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  bool has(double value, double tolerance) const {
    return std::isfinite(value) && value >= low - tolerance && value <= high + tolerance;
  }
};

Range range_around(std::size_t at, const Channel& channel, const Topic& topic,
                   const Samples& reference) {
  Range range;
  const std::size_t last = std::min(at + 2, reference.size());
  for (std::size_t i = at > 0 ? at - 1 : 0; i < last; ++i) {
    const double value = value_of(channel, reference[i]);
    if (!topic.is_in(reference[i]) || !std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

// Some successive ticks. A tick is judged with its two neighbours, so the last tick of a part waits
// here for the next part, and the tick before it stays with it.
struct TickWindow {
  Samples got, logged, reference;
  std::vector<bool> leaves_out;
  std::size_t first_tick = 0;
  std::uint64_t begin_us = 0;  // the time of tick 0

  void add(const Trace& more_got, const Trace& more_logged, const Trace& more_reference,
           const std::vector<bool>& left_out) {
    if (logged.size() == 0 && !more_logged.samples.empty()) {
      begin_us = more_logged.samples.front().in.timestamp;
    }
    got.add(more_got);
    logged.add(more_logged);
    reference.add(more_reference);
    leaves_out.insert(leaves_out.end(), left_out.begin(), left_out.end());
    leaves_out.resize(logged.size());
  }

  void keep_last() {
    for (Samples* samples : {&got, &logged, &reference}) samples->keep_last();
    const auto kept = static_cast<std::ptrdiff_t>(logged.size());
    first_tick += leaves_out.size() - logged.size();
    leaves_out.erase(leaves_out.begin(), leaves_out.end() - kept);
  }
};

// The deviations of a topic. Their memory does not grow with the log: when there are many, they are
// rounded up to 11 bits, by less than 0.1%, and equal ones are counted.
class Deviations {
 public:
  void add(double deviation) {
    largest_ = std::max(largest_, deviation);
    ++count_;
    exact_.push_back(deviation);
    if (exact_.size() == most_exact) round_all();
  }

  double largest() const { return largest_; }

  // The deviation that this part of them does not exceed (nearest rank). REQUIRES: add() is not
  // called again.
  double quantile(double part) {
    if (count_ == 0) return 0;
    if (!rounded_.empty()) round_all();
    const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(count_)));
    return std::min(at_rank(rank), largest_);
  }

 private:
  static constexpr std::size_t most_exact = 1 << 16;
  static constexpr std::uint64_t dropped_bits = (std::uint64_t{1} << 42) - 1;

  // The bits of numbers that are not negative have the order of the numbers.
  void round_all() {
    for (const double value : exact_) {
      const auto bits = std::bit_cast<std::uint64_t>(value);
      ++rounded_[std::bit_cast<double>((bits + dropped_bits) & ~dropped_bits)];
    }
    exact_.clear();
  }

  double at_rank(std::size_t rank) {
    if (rounded_.empty()) {
      const auto nth = exact_.begin() + static_cast<std::ptrdiff_t>(rank - 1);
      std::nth_element(exact_.begin(), nth, exact_.end());
      return *nth;
    }
    auto at = rounded_.begin();
    for (std::size_t up_to = at->second; up_to < rank; up_to += at->second) ++at;
    return at->first;
  }

  std::vector<double> exact_;
  std::map<double, std::size_t> rounded_;  // value -> how often
  std::size_t count_ = 0;
  double largest_ = 0;
};

class Agreement {
 public:
  Agreement(Topic topic, const TickWindow& window, const LogLimits& limits,
            LogAgreement::Neighbours neighbours)
      : topic_(std::move(topic)), window_(window), limits_(limits), neighbours_(neighbours) {
    found_.topic = topic_.name;
  }

  // `at`: the place of the tick in the window.
  void judge(std::size_t at) {
    if (!topic_.is_in(window_.logged[at])) return;
    if (window_.leaves_out[at])
      leave_out(at);
    else
      add(at);
  }

  TopicAgreement finish() {
    found_.median = deviations_.quantile(0.5);
    found_.p90 = deviations_.quantile(0.9);
    found_.p99 = deviations_.quantile(0.99);
    found_.largest = deviations_.quantile(1);
    return found_;
  }

 private:
  void add(std::size_t at) {
    ++found_.paired;
    if (!topic_.is_in(window_.got[at])) {
      ++found_.missing;
      found_.mistakes += reference_agrees(at) ? 1 : 0;
      return note(at, topic_.fields.front());
    }
    std::size_t worst = topic_.fields.front();
    double largest = deviation_at(at, worst);
    for (const std::size_t field : topic_.fields) {
      const double deviation = deviation_at(at, field);
      if (deviation > largest) worst = field;
      largest = std::max(largest, deviation);
    }
    // A deviation from a number is infinite.
    if (std::isinf(largest) && has_no_number(at) && reference_is_finite(at)) ++found_.non_finite;
    if (largest > deviations_.largest()) found_.worst = pair_at(at, worst);
    deviations_.add(largest);
    constexpr double gross = 10;  // no right port rounds so differently
    if (largest > gross * limits_.within && reference_agrees(at)) ++found_.mistakes;
    if (largest <= limits_.within)
      ++found_.within;
    else if (is_between(at))
      ++found_.between_samples;
    else
      note(at, worst);
  }

  double deviation_at(std::size_t at, std::size_t field) const {
    const Channel& channel = channels_[field];
    return attest::distance(value_of(channel, window_.got[at]),
                            value_of(channel, window_.logged[at]));
  }

  // Also at a tick that is left out, the port's output must be finite if those of reference and log
  // are.
  void leave_out(std::size_t at) {
    ++found_.left_out;
    if (topic_.is_in(window_.got[at]) && has_no_number(at) && reference_is_finite(at)) {
      ++found_.non_finite;
    }
  }

  bool reference_is_finite(std::size_t at) const {
    return std::all_of(topic_.fields.begin(), topic_.fields.end(), [&](std::size_t field) {
      return std::isfinite(value_of(channels_[field], window_.reference[at]));
    });
  }

  bool reference_agrees(std::size_t at) const {
    if (!topic_.is_in(window_.reference[at])) return false;
    return std::all_of(topic_.fields.begin(), topic_.fields.end(), [&](std::size_t field) {
      const Channel& channel = channels_[field];
      return attest::distance(value_of(channel, window_.reference[at]),
                              value_of(channel, window_.logged[at])) <= limits_.within;
    });
  }

  // True if the log has a number in a field and the port has none.
  bool has_no_number(std::size_t at) const {
    return std::any_of(topic_.fields.begin(), topic_.fields.end(), [&](std::size_t field) {
      const Channel& channel = channels_[field];
      return !std::isfinite(value_of(channel, window_.got[at])) &&
             std::isfinite(value_of(channel, window_.logged[at]));
    });
  }

  bool is_between(std::size_t at) const {
    if (neighbours_ == LogAgreement::Neighbours::do_not_explain) return false;
    return std::all_of(topic_.fields.begin(), topic_.fields.end(), [&](std::size_t field) {
      const Channel& channel = channels_[field];
      if (deviation_at(at, field) <= limits_.within) return true;
      const Range range = range_around(at, channel, topic_, window_.reference);
      return range.has(value_of(channel, window_.logged[at]), limits_.within) &&
             range.has(value_of(channel, window_.got[at]), limits_.within);
    });
  }

  void note(std::size_t at, std::size_t field) {
    if (!found_.first_unexplained) found_.first_unexplained = pair_at(at, field);
  }

  LoggedPair pair_at(std::size_t at, std::size_t field) const {
    const Channel& channel = channels_[field];
    const std::uint64_t time_us = window_.logged[at].in.timestamp;
    return {window_.first_tick + at,
            time_us,
            static_cast<double>(time_us - window_.begin_us) * 1e-6,
            field,
            value_of(channel, window_.got[at]),
            value_of(channel, window_.logged[at])};
  }

  std::span<const Channel> channels_ = channels();
  Topic topic_;
  const TickWindow& window_;
  LogLimits limits_;
  LogAgreement::Neighbours neighbours_;
  Deviations deviations_;
  TopicAgreement found_;
};

double part_of(std::size_t count, std::size_t all) {
  return all == 0 ? 0 : static_cast<double>(count) / static_cast<double>(all);
}

}  // namespace

double TopicAgreement::part_within() const { return part_of(within, paired); }
double TopicAgreement::part_unexplained() const { return part_of(unexplained(), paired); }

bool TopicAgreement::agrees(const LogLimits& limits) const {
  return paired > 0 && non_finite == 0 && mistakes == 0 &&
         part_within() >= limits.least_part_within && part_unexplained() <= limits.most_unexplained;
}

struct LogAgreement::Impl {
  TickWindow window;
  std::size_t judged = 0;  // ticks of the window
  std::vector<Agreement> topics;

  void judge_until(std::size_t end) {
    for (; judged < end; ++judged) {
      for (Agreement& topic : topics) topic.judge(judged);
    }
  }
};

LogAgreement::LogAgreement(const ChannelSet& logged, const LogLimits& limits, Neighbours neighbours)
    : impl_(std::make_unique<Impl>()) {
  for (Topic& topic : topics_in(logged)) {
    impl_->topics.emplace_back(std::move(topic), impl_->window, limits, neighbours);
  }
}
LogAgreement::LogAgreement(LogAgreement&&) noexcept = default;
LogAgreement& LogAgreement::operator=(LogAgreement&&) noexcept = default;
LogAgreement::~LogAgreement() = default;

void LogAgreement::add(const Trace& got, const Trace& logged, const Trace& reference,
                       const std::vector<bool>& leaves_out) {
  impl_->window.add(got, logged, reference, leaves_out);
  const std::size_t ticks = impl_->window.logged.size();
  if (ticks >= 2) {
    impl_->judge_until(ticks - 1);
    impl_->judged = 1;
  }
  impl_->window.keep_last();
}

std::vector<TopicAgreement> LogAgreement::finish() {
  impl_->judge_until(impl_->window.logged.size());
  std::vector<TopicAgreement> found;
  for (Agreement& topic : impl_->topics) found.push_back(topic.finish());
  return found;
}

}  // namespace attest
