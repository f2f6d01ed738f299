#include "harness/casefile/parse_limits.hpp"

#include <algorithm>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"

namespace attest {

Result<void> check_ticks(const Case& the_case, const LoopRate& rate, std::int64_t most) {
  const std::int64_t ticks = tick_count(the_case.duration, rate.motor_unit);
  if (ticks <= most) return {};
  return fail_at(the_case.file.string(),
                 fmt::format("is {} ticks at {} Hz, and at most {} are possible; use a lower rate "
                             "or a shorter time",
                             ticks, rate.to_string(), most));
}

namespace {

bool walks_too_far(const Signal& signal, const Timeline& timeline) {
  const auto* const walk = std::get_if<RandomWalk>(&signal);
  if (walk == nullptr) return false;
  const auto every = std::max(walk->every.on(timeline.rate), Nanoseconds(1));
  return timeline.duration / every > max_ticks;
}

bool walks_too_far(const TopicStimulus& topic, const Timeline& timeline) {
  const auto too_far = [&](const Signal& signal) { return walks_too_far(signal, timeline); };
  return std::any_of(topic.fields.begin(), topic.fields.end(),
                     [&](const FieldStimulus& field) {
                       const auto& instead = field.replacement;
                       return too_far(field.signal) ||
                              (instead && (too_far(instead->when) || too_far(instead->signal)));
                     }) ||
         std::any_of(topic.attitudes.begin(), topic.attitudes.end(),
                     [&](const AttitudeStimulus& stimulus) {
                       const auto& angles = stimulus.attitude.angles_deg;
                       return std::any_of(angles.begin(), angles.end(), too_far);
                     });
}

void complain_of_walk(const TomlTable& table, const std::string& key) {
  table.error(key, fmt::format("`{}` has a random walk with more than {} steps; give it a longer "
                               "`every_s` or `every_ticks`",
                               key, max_ticks));
}

void check_topic(const TomlTable& root, const TopicStimulus& topic, const Timeline& timeline) {
  if (walks_too_far(topic, timeline)) complain_of_walk(root, topic.topic);
  const Publication& publication = topic.publication;
  const bool is_irregular = publication.jitter > 0 || !publication.drops.empty();
  if (publication.when != Publication::When::periodic || !is_irregular) return;
  const Nanoseconds period = publication.period.on(timeline.rate);
  const std::int64_t releases = publication.rate
                                    ? publication.rate->ticks_in(timeline.duration)
                                    : timeline.duration / std::max(period, Nanoseconds(1));
  if (releases <= max_ticks) return;
  root.error(topic.topic, fmt::format("`{}` is published more than {} times at {} Hz", topic.topic,
                                      max_ticks, timeline.rate.to_string()));
}

void check_task(const TomlTable& flight, const std::string& key, const TaskTiming& timing,
                const Timeline& timeline) {
  if (timing.rate.ticks_in(timeline.duration) <= max_ticks) return;
  flight.error(key, fmt::format("`{}` runs more than {} times at {} Hz", key, max_ticks,
                                timeline.rate.to_string()));
}

void check_flight(const TomlTable& flight, const Case& the_case, const Timeline& timeline) {
  const Flight& parsed = *the_case.flight;
  check_task(flight, the_case.attitude_loop ? "allocator_status" : "motor_limits",
             parsed.saturation, timeline);
  if (parsed.battery) check_task(flight, "battery", parsed.battery->timing, timeline);
  const auto check = [&](const char* key, const std::array<Signal, 3>& signals) {
    const bool too_far = std::any_of(signals.begin(), signals.end(), [&](const Signal& signal) {
      return walks_too_far(signal, timeline);
    });
    if (too_far) complain_of_walk(flight, key);
  };
  check("wind_m_s", parsed.wind_m_s);
  check("centre_of_mass_of_arm", parsed.centre_of_mass_of_arm);
}

}  // namespace

void check_limits(const TomlTable& root, const Case& parsed) {
  if (parsed.rates.empty()) return;
  // A case in ticks lasts longest at the slowest rate.
  const Timeline timeline = timeline_of(parsed, parsed.rates.front().motor_unit);
  for (const TopicStimulus& topic : parsed.topics) check_topic(root, topic, timeline);
  if (parsed.attitude_loop) {
    for (const TopicStimulus& topic : parsed.attitude_loop->topics) {
      check_topic(root, topic, timeline);
    }
  }
  for (const ParameterStimulus& parameter : parsed.parameters) {
    if (walks_too_far(parameter.signal, timeline)) {
      complain_of_walk(root.table("parameters"), parameter.name);
    }
  }
  if (parsed.flight) check_flight(root.table("flight"), parsed, timeline);
}

}  // namespace attest
