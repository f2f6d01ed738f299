#include "harness/ulog/unit_log.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "harness/ulog/own_topics.hpp"
#include "harness/ulog/paired_output.hpp"

namespace attest::ulog {
namespace {

// Gives each step the samples of one input topic.
class PendingRows {
 public:
  PendingRows(const LogSeries& series, Module module, LogRules rules)
      : series_(series), module_(module), rules_(rules) {
    updated_ = channels()[updated_channel(module, series.name())].bit;
    is_shared_ = find_channel(module, "out/" + series.name() + ".published").has_value();
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
           series_.time(row) - last.in.timestamp <= latest_answer_us && is_shared_ &&
           publishes(module_, series_.name(), last);
  }

  const LogSeries& series_;
  Module module_;
  LogRules rules_;
  std::uint32_t updated_;
  bool is_shared_;  // the unit publishes the topic, too
  std::size_t next_ = 0;
};

// The inputs of a unit, step by step.
class LoggedInputs {
 public:
  // `first`: the sample before the first step.
  LoggedInputs(const ModuleContents& log, const Sample& first, LogRules rules)
      : steps_(log.steps()), last_(first), held_(first) {
    for (const LogSeries& series : log.series()) {
      if (series.is_output() || &series == &steps_) continue;
      topics_.emplace_back(series, log.module(), rules);
    }
  }

  const Sample& next() {
    const std::uint64_t time = steps_.time(tick_);
    Sample now = held_;
    for (PendingRows& rows : topics_) rows.advance_to(time, last_, now);
    steps_.copy(tick_++, now);
    now.in.timestamp = time;
    held_ = last_ = now;
    held_.in.updated = 0;
    return last_;
  }

 private:
  const LogSeries& steps_;
  std::vector<PendingRows> topics_;
  Sample last_;
  Sample held_;  // the inputs of the last step, of which none is new
  std::size_t tick_ = 0;
};

// Finds out, tick by tick, whether the log shows the setpoint that the unit follows.
class SetpointKnown {
 public:
  SetpointKnown(Module module, LogRules rules) : module_(module), rules_(rules) {
    if (rules != LogRules::cascade) return;
    setpoint_ = &channels()[updated_channel(module, info_of(module).setpoint_topic)];
    mode_ = &channels()[updated_channel(module, "vehicle_control_mode")];
  }

  Known next(const Sample& sample) {
    if (rules_ != LogRules::cascade) return Known::all;
    has_mode_ = has_mode_ || value_of(*mode_, sample) != 0;
    if (value_of(*setpoint_, sample) != 0) now_ = Known::all;
    if (module_ == Module::attitude_unit) {
      if (is_of_sticks(sample)) now_ = Known::if_every_step;
    } else if (publishes(module_, "vehicle_rates_setpoint", sample)) {
      now_ = Known::all;
    }
    return has_mode_ ? now_ : Known::nothing;
  }

  bool has_mode() const { return has_mode_ || rules_ != LogRules::cascade; }

 private:
  Module module_;
  LogRules rules_;
  const Channel* setpoint_ = nullptr;
  const Channel* mode_ = nullptr;
  bool has_mode_ = false;
  Known now_ = Known::nothing;
};

class TicksOfLog final : public LoggedTicks {
 public:
  TicksOfLog(ModuleContents log, const Sample& first, LogRules rules, std::string file)
      : log_(std::move(log)),
        first_(first),
        rules_(rules),
        file_(std::move(file)),
        update_(channels()[updated_channel(log_.module(), "parameter_update")]),
        setpoint_(log_.module(), rules_) {
    present_ = channels_of(log_.module(), "in/");
    present_.set(0);  // timestamp
    parameters_ = std::exchange(log_.parameters, {});
    std::erase_if(parameters_,
                  [&](const ParameterChange& change) { return change.tick >= ticks(); });
    for (const ParameterChange& change : parameters_) updates_.push_back(change.tick);
    pair_outputs();
    inputs_.emplace(log_, first_, rules_);
  }
  TicksOfLog(const TicksOfLog&) = delete;
  TicksOfLog& operator=(const TicksOfLog&) = delete;

  const std::string& file() const override { return file_; }
  const ChannelSet& present() const override { return present_; }

  // What LoggedUnit says of the ticks.
  void describe(LoggedUnit& unit) const {
    unit.module = log_.module();
    unit.step_topic = log_.steps().name();
    unit.trace.source = file_;
    unit.trace.present = present_;
    unit.trace.parameters = parameters_;
    unit.begins_in_flight = begins_in_flight_;
    unit.has_every_step = begins_with_mode_;
    for (const LogSeries& series : log_.series()) {
      if (series.left_out() + series.without_time() > 0) unit.has_every_step = false;
    }
    for (const PairedOutput& output : outputs_) {
      unit.outputs.push_back(output.logged());
      if (output.logged().paired < output.logged().samples) unit.has_every_step = false;
    }
  }

  Result<void> next_part(std::size_t most, Trace& part) override {
    part.source = file_;
    part.present = present_;
    part.samples.clear();
    known_.clear();
    const std::size_t first = tick_;
    while (tick_ < ticks() && part.samples.size() < most) {
      part.samples.push_back(next());
      known_.push_back(setpoint_.next(part.samples.back()));
    }
    part.parameters = changes_in(parameters_, first, part.samples.size());
    return {};
  }

  Result<void> rewind() override {
    tick_ = next_update_ = 0;
    inputs_.emplace(log_, first_, rules_);
    setpoint_ = SetpointKnown(log_.module(), rules_);
    return {};
  }

 private:
  std::size_t ticks() const { return log_.steps().size(); }

  // Whether the trace has this output. In a log of attest, a topic without samples counts, too: the
  // unit never published it.
  bool is_logged(const LogSeries& output) const {
    if (!output.is_located() || output.logged_channels().empty()) return false;
    return output.size() > 0 || rules_ == LogRules::attest;
  }

  void pair_outputs() {
    for (const LogSeries& series : log_.series()) {
      if (!series.is_output() || !is_logged(series)) continue;
      outputs_.emplace_back(log_, series, rules_);
      present_.set(*series.topic().is_new);
      for (const std::size_t channel : series.logged_channels()) present_.set(channel);
    }
    for (PairedOutput& output : outputs_) output.pair_until(0, nullptr);
    LoggedInputs inputs(log_, first_, rules_);
    // Only in a log of the cascade it depends on the inputs which samples are of the unit.
    const std::size_t steps = rules_ == LogRules::cascade ? ticks() : 1;
    for (std::size_t tick = 0; tick < steps; ++tick) {
      const Sample& step = inputs.next();
      const std::size_t until = tick + 1 == steps ? ticks() : tick + 1;
      for (PairedOutput& output : outputs_) output.pair_until(until, &step);
      if (tick == 0) look_at_first(step);
    }
  }

  void look_at_first(const Sample& step) {
    SetpointKnown setpoint(log_.module(), rules_);
    setpoint.next(step);
    begins_with_mode_ = setpoint.has_mode();
    begins_in_flight_ = rules_ == LogRules::cascade && is_in_flight(log_.module(), step);
    resets_before_ = step.attitude_in.vehicle_attitude.quat_reset_counter;
  }

  Sample next() {
    Sample sample = inputs_->next();
    if (rules_ == LogRules::cascade && log_.module() == Module::attitude_unit) {
      auto& counter = sample.attitude_in.vehicle_attitude.quat_reset_counter;
      counter = static_cast<std::uint8_t>(counter - resets_before_);
    }
    while (next_update_ < updates_.size() && updates_[next_update_] <= tick_) {
      if (updates_[next_update_++] > 0) set_value(update_, sample, 1);
    }
    for (const PairedOutput& output : outputs_) output.add_to(tick_, before_, sample);
    ++tick_;
    before_ = sample;
    return sample;
  }

  ModuleContents log_;
  Sample first_;
  LogRules rules_;
  std::string file_;
  ChannelSet present_;
  std::vector<PairedOutput> outputs_;
  std::vector<std::size_t> updates_;  // the ticks of the log's changes of parameters
  const Channel& update_;
  bool begins_with_mode_ = false;
  bool begins_in_flight_ = false;
  std::uint8_t resets_before_ = 0;

  // The next tick.
  std::size_t tick_ = 0;
  std::size_t next_update_ = 0;
  std::optional<LoggedInputs> inputs_;
  SetpointKnown setpoint_;
  Sample before_;  // the tick before
};

}  // namespace

LoggedUnit unit_of_log(ModuleContents log, const Sample& first, LogRules rules,
                       const std::string& file) {
  const auto ticks = std::make_shared<TicksOfLog>(std::move(log), first, rules, file);
  LoggedUnit unit;
  ticks->describe(unit);
  unit.ticks = ticks;
  return unit;
}

}  // namespace attest::ulog
