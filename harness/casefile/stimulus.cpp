#include "harness/casefile/stimulus.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/schedule/ticks.hpp"

namespace attest {
namespace {

bool is_whole_ticks(const Span& span) {
  return span.in == Span::In::ticks && span.amount == std::floor(span.amount);
}

bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// One topic on a timeline: publishes into a sample.
class Publisher {
 public:
  Publisher(const TopicStimulus& topic, const Timeline& timeline)
      : topic_(topic), rate_(timeline.rate) {
    for (const FieldStimulus& field : topic.fields) {
      fields_.emplace_back(field.channel, Sampler(field.signal, timeline));
      varies_ = varies_ || varies(field.signal);
    }
    for (const auto& [channel, attitude] : topic.attitudes) {
      attitudes_.push_back({channel, attitude, Sampler(attitude.tilt_deg, timeline),
                            Sampler(attitude.azimuth_deg, timeline),
                            Sampler(attitude.yaw_deg, timeline)});
      varies_ = varies_ || varies(attitude.tilt_deg) || varies(attitude.azimuth_deg) ||
                varies(attitude.yaw_deg);
    }
    plan_releases(topic.publication);
  }

  // Publishes what was released since the last tick, if anything.
  void tick(Nanoseconds now, Sample& sample) {
    const auto release = every_tick_ ? std::optional(now) : releases_.latest(now);
    if (!release || (published_ && *release <= *published_)) return;
    published_ = release;
    sample.in.updated |= topic_.updated_bit;
    for (const auto& [channel, sampler] : fields_) {
      set_value(channels()[channel], sample, sampler.at(*release));
    }
    for (const Attitude& attitude : attitudes_) attitude.write(*release, sample);
  }

 private:
  struct Attitude {
    std::size_t channel;
    AttitudeSignal signal;
    Sampler tilt, azimuth, yaw;

    void write(Nanoseconds time, Sample& sample) const {
      const auto [w, x, y, z] = attitude_from(tilt.at(time), azimuth.at(time), yaw.at(time));
      const double scale = signal.sign * signal.norm;
      std::size_t i = channel;
      for (const double component : {w, x, y, z}) {
        set_value(channels()[i++], sample, scale * component);
      }
    }
  };

  void plan_releases(const Publication& publication) {
    using When = Publication::When;
    switch (publication.when) {
      case When::automatic:
        // What never changes is published once, as the first tick begins.
        every_tick_ = varies_ || topic_.updated_bit == 0;
        if (!every_tick_) releases_.times = {Nanoseconds(0)};
        break;
      case When::every_tick:
        every_tick_ = true;
        break;
      case When::periodic:
        plan_periodic(publication);
        break;
      case When::at_times:
        for (const Span& time : publication.times) releases_.times.push_back(time.on(rate_));
        break;
      case When::never:
        break;
    }
  }

  // A period of whole ticks is every n-th tick of the unit: at 333 Hz, too, a release and the tick
  // that it belongs to are at the same nanosecond.
  void plan_periodic(const Publication& publication) {
    const auto& [when, rate, period, phase, times] = publication;
    if (rate || !is_whole_ticks(period)) {
      releases_.rate = rate ? *rate : every(period.on(rate_));
      releases_.phase = phase.on(rate_);
      return;
    }
    releases_.rate = rate_;
    releases_.every = static_cast<std::int64_t>(period.amount);
    if (is_whole_ticks(phase)) {
      releases_.first = static_cast<std::int64_t>(phase.amount);
    } else {
      releases_.phase = phase.on(rate_);
    }
  }

  static Rate every(Nanoseconds period) {
    return Rate::hz(1'000'000'000, std::max<std::int64_t>(period.count(), 1));
  }

  const TopicStimulus& topic_;
  Rate rate_;
  std::vector<std::pair<std::size_t, Sampler>> fields_;
  std::vector<Attitude> attitudes_;
  bool varies_ = false;
  bool every_tick_ = false;
  ReleaseSchedule releases_;
  std::optional<Nanoseconds> published_;
};

// Parameters in force, and what of them changes.
class ParameterPublisher {
 public:
  ParameterPublisher(const std::vector<ParameterStimulus>& parameters, const Timeline& timeline) {
    for (const ParameterStimulus& parameter : parameters) {
      entries_.push_back({parameter.name, Sampler(parameter.signal, timeline), std::nullopt});
    }
  }

  void tick(Nanoseconds now, Trace& trace, Sample& sample) {
    const std::size_t tick = trace.samples.size();
    // parameter_update is published once when the firmware starts.
    if (tick == 0) sample.in.updated |= ATTEST_UPDATED_PARAMETER_UPDATE;
    for (Entry& entry : entries_) {
      const auto value = static_cast<float>(entry.sampler.at(now));
      if (entry.last && same(*entry.last, value)) continue;
      entry.last = value;
      trace.parameters.push_back({tick, entry.name, value});
      sample.in.updated |= ATTEST_UPDATED_PARAMETER_UPDATE;
    }
  }

 private:
  struct Entry {
    std::string name;
    Sampler sampler;
    std::optional<float> last;
  };
  std::vector<Entry> entries_;
};

}  // namespace

Trace stimulate(const Case& the_case, const Rate& rate) {
  const std::int64_t periods = tick_count(the_case.duration, rate);
  const Timeline timeline{rate, rate.tick(periods)};
  const Nanoseconds start = the_case.unit.start.on(rate);

  std::vector<Publisher> publishers;
  for (const TopicStimulus& topic : the_case.topics) publishers.emplace_back(topic, timeline);
  ParameterPublisher parameters(the_case.parameters, timeline);

  Trace trace;
  trace.source = fmt::format("{}@{}", the_case.id(), rate.label());
  trace.present = channels_with_prefix("");
  TickSchedule schedule{rate, Nanoseconds(0), the_case.unit.jitter, the_case.unit.seed,
                        the_case.unit.drop_ticks};
  Sample sample{};
  for (const Nanoseconds now : ticks(schedule, periods)) {
    sample.in.timestamp = timestamp_us(start + now);
    sample.in.updated = 0;
    for (Publisher& publisher : publishers) publisher.tick(now, sample);
    parameters.tick(now, trace, sample);
    trace.samples.push_back(sample);
  }
  return trace;
}

}  // namespace attest
