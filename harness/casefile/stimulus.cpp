#include "harness/casefile/stimulus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "controller/actuation/mixer.hpp"
#include "harness/core/agreement.hpp"
#include "harness/core/ticks.hpp"

namespace attest {
namespace {

bool is_whole_ticks(const Span& span) {
  return span.in == Span::In::ticks && span.amount == std::floor(span.amount);
}

class Publisher {
 public:
  // `start`: the timestamp at time 0 of the case.
  Publisher(const TopicStimulus& topic, const Timeline& timeline, Nanoseconds start)
      : topic_(topic), timeline_(timeline), delay_(topic.publication.delay.on(timeline.rate)) {
    for (const FieldStimulus& field : topic.fields) {
      fields_.emplace_back(field, timeline, start);
      varies_ = varies_ || varies(field.signal);
      if (const auto& replaced = field.replacement) {
        varies_ = varies_ || varies(replaced->when) || varies(replaced->signal);
      }
    }
    for (const auto& [channel, attitude] : topic.attitudes) {
      const auto& angles = attitude.angles_deg;
      attitudes_.push_back({channel,
                            attitude,
                            {Sampler(angles[0], timeline), Sampler(angles[1], timeline),
                             Sampler(angles[2], timeline)}});
      varies_ = varies_ || std::any_of(angles.begin(), angles.end(), varies);
    }
    plan_releases(topic.publication);
  }

  // Publishes the latest sample that was released since the last tick, if there is one.
  void tick(Nanoseconds now, Sample& sample) {
    const Nanoseconds visible = now - delay_;
    if (visible < Nanoseconds(0)) return;
    const auto release = every_tick_ ? std::optional(visible) : releases_.latest(visible);
    if (!release || (published_ && *release <= *published_)) return;
    published_ = release;
    if (topic_.updated_bit != 0) sample.in.updated |= topic_.updated_bit;
    for (const Field& field : fields_) field.write(*release, sample);
    for (const Attitude& attitude : attitudes_) attitude.write(*release, sample);
  }

 private:
  struct Field {
    Field(const FieldStimulus& field, const Timeline& timeline, Nanoseconds start_of_ticks)
        : channel(field.channel),
          scale(field.scale),
          start(start_of_ticks),
          sampler(field.signal, timeline) {
      if (!field.replacement) return;
      when.emplace(field.replacement->when, timeline);
      instead.emplace(field.replacement->signal, timeline);
    }

    void write(Nanoseconds time, Sample& sample) const {
      const bool replaced = when && when->at(time) != 0;
      const double value = scale * (replaced ? *instead : sampler).at(time);
      const Channel& what = channels()[channel];
      set_value(what, sample, what.type == ChannelType::u64 ? time_us(value, time) : value);
    }

    // `seconds` is after the publication; of armed_time it is after time 0 of the case.
    double time_us(double seconds, Nanoseconds published) const {
      const bool of_start = channels()[channel].name.ends_with(".armed_time");
      const Nanoseconds from = of_start ? start : start + published;
      const double us = static_cast<double>(timestamp_us(from)) + std::round(seconds * 1e6);
      return std::clamp(us, 0.0, 0x1p53);
    }

    std::size_t channel;
    double scale;
    Nanoseconds start;
    Sampler sampler;
    std::optional<Sampler> when, instead;
  };
  struct Attitude {
    std::size_t channel;
    AttitudeSignal signal;
    std::array<Sampler, 3> angles;

    void write(Nanoseconds time, Sample& sample) const {
      const auto [w, x, y, z] =
          attitude_from(signal.by, {angles[0].at(time), angles[1].at(time), angles[2].at(time)});
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
        // A topic that never changes is published once, at time 0 of the case.
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
        for (const Span& time : publication.times) {
          releases_.times.push_back(time.on(timeline_.rate));
        }
        break;
      case When::never:
        break;
    }
  }

  // A period of n whole ticks becomes every n-th tick of the unit. So a release and its tick are at
  // the same nanosecond, even if the period is not a whole number of nanoseconds, as at 333 Hz.
  void plan_periodic(const Publication& publication) {
    const Rate& unit_rate = timeline_.rate;
    const auto& [rate, period, phase] =
        std::tie(publication.rate, publication.period, publication.phase);
    if (publication.jitter > 0 || !publication.drops.empty()) {
      plan_irregular(publication);
    } else if (rate || !is_whole_ticks(period)) {
      releases_.rate = rate ? *rate : every(period.on(unit_rate));
      releases_.phase = phase.on(unit_rate);
    } else {
      releases_.rate = unit_rate;
      releases_.every = static_cast<std::int64_t>(period.amount);
      if (is_whole_ticks(phase)) {
        releases_.first = static_cast<std::int64_t>(phase.amount);
      } else {
        releases_.phase = phase.on(unit_rate);
      }
    }
  }

  // With jitter or missing releases, the time of each release is listed.
  void plan_irregular(const Publication& publication) {
    const Rate& unit_rate = timeline_.rate;
    const Rate rate =
        publication.rate ? *publication.rate : every(publication.period.on(unit_rate));
    TickSchedule schedule;
    schedule.rate = rate;
    schedule.phase = publication.phase.on(unit_rate);
    schedule.jitter = publication.jitter;
    schedule.seed = publication.seed;
    schedule.drops = publication.drops;
    releases_.times = ticks(schedule, rate.ticks_in(timeline_.duration));
  }

  static Rate every(Nanoseconds period) {
    return Rate::hz(1'000'000'000, std::max<std::int64_t>(period.count(), 1));
  }

  const TopicStimulus& topic_;
  Timeline timeline_;
  Nanoseconds delay_;
  std::vector<Field> fields_;
  std::vector<Attitude> attitudes_;
  bool varies_ = false;
  bool every_tick_ = false;
  ReleaseSchedule releases_;
  std::optional<Nanoseconds> published_;
};

class ParameterPublisher {
 public:
  ParameterPublisher(const std::vector<ParameterStimulus>& parameters, const Timeline& timeline) {
    for (const ParameterStimulus& parameter : parameters) {
      entries_.push_back({parameter.name, Sampler(parameter.signal, timeline), std::nullopt});
    }
  }

  // Adds the parameters that change. Returns whether parameter_update is published: with each
  // change, and once when the firmware starts.
  bool tick(std::size_t tick, Nanoseconds now, std::vector<ParameterChange>& changes) {
    const std::size_t before = changes.size();
    for (Entry& entry : entries_) {
      const auto value = static_cast<float>(entry.sampler.at(now));
      if (entry.last && same_bits(*entry.last, value)) continue;
      entry.last = value;
      changes.push_back({tick, entry.name, value});
    }
    return tick == 0 || changes.size() > before;
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

Timeline timeline_of(const Case& the_case, const Rate& rate) {
  return {rate, rate.tick(tick_count(the_case.duration, rate))};
}

std::vector<Nanoseconds> unit_ticks(const Case& the_case, const Rate& rate, double faster) {
  const UnitTiming& unit = the_case.unit;
  TickSchedule schedule;
  schedule.rate = rate;
  schedule.jitter = unit.jitter;
  schedule.heavy_tail = unit.heavy_tail;
  schedule.seed = unit.seed;
  schedule.drops = unit.drop_ticks;
  schedule.drop_every = unit.drop_every;
  if (unit.stall) {
    const auto& [every, length, catches_up] = *unit.stall;
    schedule.stall = {every.on(rate), length.on(rate), catches_up};
  }
  const std::int64_t periods = tick_count(the_case.duration, rate);
  if (faster == 0) return ticks(schedule, periods);
  const double most = std::ceil(static_cast<double>(periods) * (1 + faster));
  std::vector<Nanoseconds> times = ticks(schedule, static_cast<std::int64_t>(most));
  for (Nanoseconds& time : times) {
    time = Nanoseconds(static_cast<std::int64_t>(static_cast<double>(time.count()) / (1 + faster)));
  }
  const Nanoseconds end = timeline_of(the_case, rate).duration;
  std::erase_if(times, [&](Nanoseconds time) { return time >= end; });
  return times;
}

struct Stimulus::Impl {
  Impl(const Case& the_case, const Rate& rate)
      : module(the_case.module),
        start(the_case.unit.start.on(rate)),
        parameters(the_case.parameters, timeline_of(the_case, rate)) {
    const Timeline timeline = timeline_of(the_case, rate);
    for (const TopicStimulus& topic : the_case.topics)
      publishers.emplace_back(topic, timeline, start);
  }

  Module module;
  Nanoseconds start;
  std::vector<Publisher> publishers;
  ParameterPublisher parameters;
};

Stimulus::Stimulus(const Case& the_case, const Rate& rate)
    : impl_(std::make_unique<Impl>(the_case, rate)) {}
Stimulus::Stimulus(Stimulus&&) noexcept = default;
Stimulus::~Stimulus() = default;

std::uint64_t Stimulus::timestamp_us(Nanoseconds time) const {
  return attest::timestamp_us(impl_->start + time);
}

void Stimulus::tick(std::size_t tick, Nanoseconds now, Sample& sample,
                    std::vector<ParameterChange>& changes) {
  sample.in.timestamp = timestamp_us(now);
  const bool has_bits = info_of(impl_->module).is_unit();
  if (has_bits) sample.in.updated = 0;
  for (Publisher& publisher : impl_->publishers) publisher.tick(now, sample);
  const bool is_update = impl_->parameters.tick(tick, now, changes);
  if (has_bits && is_update) sample.in.updated |= ATTEST_UPDATED_PARAMETER_UPDATE;
}

namespace {

// Without the outputs beyond the number of the mixer's rotors.
ChannelSet channels_of(const Case& the_case) {
  ChannelSet channels = attest::channels_of(the_case.module);
  if (the_case.module != Module::mixer) return channels;
  const std::size_t rotors = actuation::parse_mixer(the_case.mixer)->rotors.size();
  const std::size_t first = *find_channel(Module::mixer, "out/actuator_outputs.output[0]");
  for (std::size_t i = rotors; i < actuation::rotors_max; ++i) channels.reset(first + i);
  return channels;
}

}  // namespace

Trace stimulate(const Case& the_case, const Rate& rate) {
  Trace trace;
  trace.source = fmt::format("{}@{}", the_case.id(), rate.label());
  trace.present = channels_of(the_case);
  Stimulus stimulus(the_case, rate);
  const std::vector<Nanoseconds> ticks = unit_ticks(the_case, rate);
  trace.samples.reserve(ticks.size());
  Sample sample{};
  for (const Nanoseconds now : ticks) {
    stimulus.tick(trace.samples.size(), now, sample, trace.parameters);
    trace.samples.push_back(sample);
  }
  return trace;
}

}  // namespace attest
