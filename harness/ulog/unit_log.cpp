#include "harness/ulog/unit_log.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/ulog/own_topics.hpp"

namespace attest::ulog {
namespace {

// An output that is more than this after a step does not belong to it. An attitude unit runs at up
// to 250 Hz, and publishes a fraction of a millisecond after its sample.
constexpr std::uint64_t latest_answer_us = 2000;

// Gives each step the samples of one input topic.
class PendingRows {
 public:
  PendingRows(const LogSeries& series, Module module, LogRules rules)
      : series_(series), module_(module), rules_(rules) {
    const auto bit = find_channel(module, "in/updated." + series.name());
    updated_ = channels()[*bit].bit;
  }

  // Copies the last sample of the topic before the step at `time` to `sample`, if it is newer than
  // that of the previous call. `last`: the sample of the previous step; at the first step, the
  // sample before it.
  void advance_to(std::uint64_t time, const Sample& last, Sample& sample) {
    std::optional<std::size_t> newest;
    for (bool is_first = true; next_ < series_.size() && is_there(next_, time); is_first = false) {
      const std::size_t row = next_++;
      if (!is_first || !is_own(row, last)) newest = row;
    }
    if (!newest) return;
    series_.copy(*newest, sample);
    sample.in.updated |= updated_;
  }

 private:
  bool is_there(std::size_t row, std::uint64_t time) const {
    return series_.time(row) < time || (rules_ != LogRules::cascade && series_.time(row) == time);
  }

  // Whether the unit itself published `row`, the first sample after the step of `last`. The unit
  // publishes once in a step, soon after the step's time.
  bool is_own(std::size_t row, const Sample& last) const {
    return rules_ == LogRules::cascade && last.in.timestamp > 0 &&
           series_.time(row) - last.in.timestamp <= latest_answer_us && is_shared() &&
           publishes(module_, series_.name(), last);
  }

  bool is_shared() const {
    return find_channel(module_, "out/" + series_.name() + ".published").has_value();
  }

  const LogSeries& series_;
  Module module_;
  LogRules rules_;
  std::uint32_t updated_;
  std::size_t next_ = 0;
};

class UnitOfLog {
 public:
  UnitOfLog(ModuleContents& log, LogRules rules) : log_(log), steps_(log.steps()), rules_(rules) {
    unit_.module = log.module();
    unit_.step_topic = steps_.name();
    unit_.trace.present = channels_of(log.module(), "in/");
    unit_.trace.present.set(0);  // timestamp
    const auto sampled = steps_.sample_times();
    has_sample_times_ =
        sampled.size() == steps_.size() && std::is_sorted(sampled.begin(), sampled.end());
  }

  LoggedUnit made(const Sample& first) && {
    fill_inputs(first);
    fill_parameters();
    unit_.has_every_step = true;
    for (const LogSeries& series : log_.series()) {
      if (series.left_out() + series.without_time() > 0) unit_.has_every_step = false;
      if (series.is_output() && is_logged(series)) fill_outputs(series);
    }
    note_known();
    return std::move(unit_);
  }

 private:
  Trace& trace() { return unit_.trace; }

  // Whether the trace has this output. In a log of attest, a topic without samples counts, too: the
  // unit never published it.
  bool is_logged(const LogSeries& output) const {
    if (!output.is_located() || output.logged_channels().empty()) return false;
    return output.size() > 0 || rules_ == LogRules::attest;
  }

  void fill_inputs(Sample sample) {
    std::vector<PendingRows> inputs;
    for (const LogSeries& series : log_.series()) {
      if (series.is_output() || &series == &steps_) continue;
      inputs.emplace_back(series, log_.module(), rules_);
    }
    trace().samples.reserve(steps_.size());
    for (std::size_t tick = 0; tick < steps_.size(); ++tick) {
      const Sample& last = tick == 0 ? sample : trace().samples[tick - 1];
      Sample now = sample;
      for (PendingRows& rows : inputs) rows.advance_to(steps_.time(tick), last, now);
      steps_.copy(tick, now);
      now.in.timestamp = steps_.time(tick);
      trace().samples.push_back(now);
      sample = now;
      sample.in.updated = 0;
    }
    if (rules_ == LogRules::cascade && log_.module() == Module::attitude_unit) count_resets();
  }

  void count_resets() {
    const auto before = trace().samples.front().attitude_in.vehicle_attitude.quat_reset_counter;
    for (Sample& sample : trace().samples) {
      auto& counter = sample.attitude_in.vehicle_attitude.quat_reset_counter;
      counter = static_cast<std::uint8_t>(counter - before);
    }
  }

  void fill_parameters() {
    auto changes = std::move(log_.parameters);
    std::erase_if(changes,
                  [&](const ParameterChange& change) { return change.tick >= steps_.size(); });
    const Channel& bit = bit_of("parameter_update");
    for (const ParameterChange& change : changes) {
      if (change.tick > 0) set_value(bit, trace().samples[change.tick], 1);
    }
    trace().parameters = std::move(changes);
  }

  void fill_outputs(const LogSeries& output) {
    LoggedOutput logged{output.name(), 0, 0};
    const std::size_t flag = *output.topic().is_new;
    const Channel& published = channels()[flag];
    trace().present.set(flag);
    for (const std::size_t channel : output.logged_channels()) trace().present.set(channel);
    for (std::size_t row = 0; row < output.size(); ++row) {
      const auto tick = tick_of(output, row);
      if (is_of_others(output, row)) continue;
      ++logged.samples;
      if (!tick || value_of(published, trace().samples[*tick]) != 0) continue;
      output.copy(row, trace().samples[*tick]);
      set_value(published, trace().samples[*tick], 1);
      ++logged.paired;
    }
    if (logged.paired < logged.samples) unit_.has_every_step = false;
    hold_unpublished(output, published);
    unit_.outputs.push_back(std::move(logged));
  }

  // The tick of the step that published the output; empty if it is not known.
  std::optional<std::size_t> tick_of(const LogSeries& output, std::size_t row) const {
    const auto sampled = output.sample_time(row);
    if (sampled && has_sample_times_) return tick_sampled_at(*sampled);
    const auto after = steps_.first_after(sampled ? *sampled : output.time(row));
    if (after == 0) return std::nullopt;
    if (sampled && steps_.time(after - 1) != *sampled) return std::nullopt;
    const bool is_late =
        rules_ == LogRules::cascade && output.time(row) - steps_.time(after - 1) > latest_answer_us;
    return is_late ? std::nullopt : std::optional(after - 1);
  }

  std::optional<std::size_t> tick_sampled_at(std::uint64_t time) const {
    const auto all = steps_.sample_times();
    const auto found = std::lower_bound(all.begin(), all.end(), time);
    if (found == all.end() || *found != time) return std::nullopt;
    return static_cast<std::size_t>(found - all.begin());
  }

  // Whether another module published this sample, because this unit does not publish the topic in
  // the mode at that time. Also true before the log's first step.
  bool is_of_others(const LogSeries& output, std::size_t row) const {
    if (rules_ != LogRules::cascade) return false;
    const auto after = steps_.first_after(output.time(row));
    return after == 0 || !publishes(log_.module(), output.name(), unit_.trace.samples[after - 1]);
  }

  // Ticks that do not publish get the values of the tick before, as the ABI requires.
  void hold_unpublished(const LogSeries& output, const Channel& published) {
    for (std::size_t tick = 1; tick < trace().samples.size(); ++tick) {
      Sample& sample = trace().samples[tick];
      if (value_of(published, sample) != 0) continue;
      for (const LogField& field : output.topic().fields) {
        const Channel& channel = channels()[field.channel];
        copy_value(channel, trace().samples[tick - 1], sample);
      }
    }
  }

  void note_known() {
    unit_.known.assign(trace().samples.size(), Known::all);
    if (rules_ != LogRules::cascade) return;
    const bool is_attitude_unit = log_.module() == Module::attitude_unit;
    const Channel& setpoint =
        bit_of(is_attitude_unit ? "vehicle_attitude_setpoint" : "vehicle_rates_setpoint");
    const Channel& mode = bit_of("vehicle_control_mode");
    bool has_mode = false;
    Known now = Known::nothing;
    for (std::size_t tick = 0; tick < unit_.known.size(); ++tick) {
      const Sample& sample = trace().samples[tick];
      has_mode = has_mode || value_of(mode, sample) != 0;
      if (value_of(setpoint, sample) != 0) now = Known::all;
      if (is_attitude_unit && is_of_sticks(sample)) now = Known::if_every_step;
      if (!is_attitude_unit && publishes(log_.module(), "vehicle_rates_setpoint", sample)) {
        now = Known::all;
      }
      unit_.known[tick] = has_mode ? now : Known::nothing;
      if (!has_mode) unit_.has_every_step = false;
    }
  }

  const Channel& bit_of(const char* topic) const {
    return channels()[*find_channel(log_.module(), fmt::format("in/updated.{}", topic))];
  }

  ModuleContents& log_;
  const LogSeries& steps_;
  LogRules rules_;
  bool has_sample_times_;  // every step has a timestamp_sample; these do not decrease
  LoggedUnit unit_;
};

}  // namespace

LoggedUnit unit_of_log(ModuleContents& log, Sample first, LogRules rules) {
  return UnitOfLog(log, rules).made(first);
}

}  // namespace attest::ulog
