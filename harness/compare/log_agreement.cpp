#include "harness/compare/log_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
    std::string_view name = table[i].name.substr(table[i].name.find('/') + 1);
    const std::string_view field = name.substr(name.find('.') + 1);
    name = name.substr(0, name.find('.'));
    if (topics.empty() || topics.back().name != name) topics.push_back({name, nullptr, {}});
    if (field == "published")
      topics.back().published = &table[i];
    else
      topics.back().fields.push_back(i);
  }
  std::erase_if(topics, [](const Topic& topic) {
    return topic.published == nullptr || topic.fields.empty();
  });
  return topics;
}

double deviation(double got, double logged) {
  if (std::isnan(got) && std::isnan(logged)) return 0;
  if (got == logged) return 0;
  const double off = std::abs(got - logged);
  return std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
}

// The range of the reference's finite values of a field at a tick and its neighbours.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  bool has(double value, double tolerance) const {
    return std::isfinite(value) && value >= low - tolerance && value <= high + tolerance;
  }
};

Range range_around(std::size_t tick, const Channel& channel, const Topic& topic,
                   const Trace& reference) {
  Range range;
  const std::size_t last = std::min(tick + 2, reference.samples.size());
  for (std::size_t i = tick > 0 ? tick - 1 : 0; i < last; ++i) {
    const double value = value_of(channel, reference.samples[i]);
    if (!topic.is_in(reference.samples[i]) || !std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

class Agreement {
 public:
  Agreement(Topic topic, const Trace& got, const Trace& logged, const Trace& reference,
            const LogLimits& limits)
      : topic_(std::move(topic)),
        got_(got),
        logged_(logged),
        reference_(reference),
        limits_(limits) {
    found_.topic = topic_.name;
  }

  TopicAgreement found(const std::vector<bool>& leaves_out) && {
    for (std::size_t tick = 0; tick < logged_.samples.size(); ++tick) {
      if (!topic_.is_in(logged_.samples[tick])) continue;
      if (tick < leaves_out.size() && leaves_out[tick])
        leave_out(tick);
      else
        add(tick);
    }
    std::sort(deviations_.begin(), deviations_.end());
    found_.median = quantile(0.5);
    found_.p90 = quantile(0.9);
    found_.p99 = quantile(0.99);
    found_.largest = quantile(1);
    return found_;
  }

 private:
  void add(std::size_t tick) {
    ++found_.paired;
    if (!topic_.is_in(got_.samples[tick])) {
      ++found_.missing;
      return note(tick, topic_.fields.front());
    }
    std::size_t worst = topic_.fields.front();
    for (const std::size_t field : topic_.fields) {
      if (deviation_at(tick, field) > deviation_at(tick, worst)) worst = field;
    }
    if (has_no_number(tick)) ++found_.non_finite;
    const double largest = deviation_at(tick, worst);
    deviations_.push_back(largest);
    if (largest <= limits_.within)
      ++found_.within;
    else if (is_between(tick))
      ++found_.between_samples;
    else
      note(tick, worst);
  }

  double deviation_at(std::size_t tick, std::size_t field) const {
    const Channel& channel = channels()[field];
    return deviation(value_of(channel, got_.samples[tick]),
                     value_of(channel, logged_.samples[tick]));
  }

  // Also at a tick that is left out, the port's output must be finite if those of reference and log
  // are.
  void leave_out(std::size_t tick) {
    ++found_.left_out;
    const auto is_finite = [&](std::size_t field) {
      return std::isfinite(value_of(channels()[field], reference_.samples[tick]));
    };
    if (topic_.is_in(got_.samples[tick]) && has_no_number(tick) &&
        std::all_of(topic_.fields.begin(), topic_.fields.end(), is_finite)) {
      ++found_.non_finite;
    }
  }

  bool has_no_number(std::size_t tick) const {
    return std::any_of(topic_.fields.begin(), topic_.fields.end(),
                       [&](std::size_t field) { return is_no_number(tick, field); });
  }

  // True if the log has a number here and the port has none.
  bool is_no_number(std::size_t tick, std::size_t field) const {
    const Channel& channel = channels()[field];
    return !std::isfinite(value_of(channel, got_.samples[tick])) &&
           std::isfinite(value_of(channel, logged_.samples[tick]));
  }

  bool is_between(std::size_t tick) const {
    return std::all_of(topic_.fields.begin(), topic_.fields.end(), [&](std::size_t field) {
      const Channel& channel = channels()[field];
      if (deviation_at(tick, field) <= limits_.within) return true;
      const Range range = range_around(tick, channel, topic_, reference_);
      return range.has(value_of(channel, logged_.samples[tick]), limits_.within) &&
             range.has(value_of(channel, got_.samples[tick]), limits_.within);
    });
  }

  void note(std::size_t tick, std::size_t field) {
    if (found_.first_unexplained) return;
    const Channel& channel = channels()[field];
    found_.first_unexplained = {tick, field, value_of(channel, got_.samples[tick]),
                                value_of(channel, logged_.samples[tick])};
  }

  double quantile(double part) const {
    if (deviations_.empty()) return 0;
    const auto rank = std::ceil(part * static_cast<double>(deviations_.size()));
    return deviations_[static_cast<std::size_t>(rank) - 1];
  }

  Topic topic_;
  const Trace& got_;
  const Trace& logged_;
  const Trace& reference_;
  LogLimits limits_;
  std::vector<double> deviations_;
  TopicAgreement found_;
};

double part_of(std::size_t count, std::size_t all) {
  return all == 0 ? 0 : static_cast<double>(count) / static_cast<double>(all);
}

}  // namespace

double TopicAgreement::part_within() const { return part_of(within, paired); }
double TopicAgreement::part_unexplained() const { return part_of(unexplained(), paired); }

bool TopicAgreement::agrees(const LogLimits& limits) const {
  return paired > 0 && non_finite == 0 && part_within() >= limits.least_part_within &&
         part_unexplained() <= limits.most_unexplained;
}

std::vector<TopicAgreement> agreement_with_log(const Trace& got, const Trace& logged,
                                               const Trace& reference, const LogLimits& limits,
                                               const std::vector<bool>& leaves_out) {
  std::vector<TopicAgreement> found;
  for (Topic& topic : topics_in(logged.present)) {
    found.push_back(Agreement(std::move(topic), got, logged, reference, limits).found(leaves_out));
  }
  return found;
}

}  // namespace attest
