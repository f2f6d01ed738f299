#include "harness/ulog/unit_log.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "harness/ulog/logged_steps.hpp"
#include "harness/ulog/own_topics.hpp"
#include "harness/ulog/single_step_maker.hpp"

namespace attest::ulog {
namespace {

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
  static Result<std::shared_ptr<TicksOfLog>> open(ModuleContents log, const Sample& first,
                                                  LogRules rules, bool finds_steps,
                                                  const std::string& file) {
    std::shared_ptr<TicksOfLog> ticks(new TicksOfLog(std::move(log), first, rules, file));
    if (finds_steps) {
      ticks->found_ =
          std::make_shared<SingleStepFinder>(ticks->from_.log.module(), ticks->parameters_);
    }
    const auto opened = ticks->pair_outputs().and_then([&] { return ticks->rewind(); });
    if (!opened) return tl::unexpected(opened.error());
    return ticks;
  }
  TicksOfLog(const TicksOfLog&) = delete;
  TicksOfLog& operator=(const TicksOfLog&) = delete;

  const std::string& file() const override { return from_.file; }
  const ChannelSet& present() const override { return present_; }

  // What LoggedUnit says of the ticks.
  void describe(LoggedUnit& unit) const {
    unit.module = from_.log.module();
    unit.step_topic = from_.log.steps().name();
    unit.trace.source = from_.file;
    unit.trace.present = present_;
    unit.trace.parameters = parameters_;
    unit.begins_in_flight = begins_in_flight_;
    unit.has_every_step = begins_with_mode_ && !leaves_out_;
    unit.outputs = outputs_;
    unit.found_steps = found_;
    for (const LoggedOutput& output : outputs_) {
      if (output.paired < output.samples) unit.has_every_step = false;
    }
  }

  Result<void> next_part(std::size_t most, Trace& part) override {
    part.source = from_.file;
    part.present = present_;
    part.samples.clear();
    setpoints_.clear();
    const std::size_t first = tick_;
    while (tick_ < from_.steps && part.samples.size() < most) {
      const auto step = steps_->next();
      if (!step) return tl::unexpected(step.error());
      part.samples.push_back((*step)->sample);
      complete(part.samples.back());
      setpoints_.push_back({setpoint_.next(part.samples.back()), (*step)->setpoint_us});
    }
    part.parameters = changes_in(parameters_, first, part.samples.size());
    return {};
  }

  Result<void> rewind() override {
    auto steps = LoggedSteps::open(from_);
    if (!steps) return tl::unexpected(steps.error());
    steps_.emplace(*std::move(steps));
    tick_ = next_update_ = 0;
    setpoint_ = SetpointKnown(from_.log.module(), from_.rules);
    return {};
  }

 private:
  TicksOfLog(ModuleContents log, const Sample& first, LogRules rules, const std::string& file)
      : from_{std::move(log), first, rules, file, {}},
        update_(channels()[updated_channel(from_.log.module(), "parameter_update")]),
        setpoint_(from_.log.module(), rules) {
    const LogSeries& steps = std::as_const(from_.log).steps();
    from_.steps = steps.size();
    from_.has_sample_times = steps.has_sample_times();
    present_ = channels_of(from_.log.module(), "in/");
    present_.set(0);  // timestamp
    parameters_ = std::exchange(from_.log.parameters, {});
    std::erase_if(parameters_,
                  [&](const ParameterChange& change) { return change.tick >= from_.steps; });
    for (const ParameterChange& change : parameters_) updates_.push_back(change.tick);
    for (LogSeries& series : from_.log.series()) {
      leaves_out_ = leaves_out_ || series.left_out() + series.without_time() > 0;
      if (series.is_output() && is_logged(series)) add_output(series);
    }
  }

  // Whether the trace has this output. In a log of attest, a topic without samples counts, too: the
  // unit never published it.
  bool is_logged(const LogSeries& output) const {
    if (!output.is_located() || output.logged_channels().empty()) return false;
    return output.size() > 0 || from_.rules == LogRules::attest;
  }

  void add_output(LogSeries& series) {
    from_.outputs.push_back(&series);
    present_.set(*series.topic().is_new);
    for (const std::size_t channel : series.logged_channels()) present_.set(channel);
  }

  // Reads the log once, because the counts of all outputs must be known before the first tick is
  // judged.
  Result<void> pair_outputs() {
    auto steps = LoggedSteps::open(from_);
    if (!steps) return tl::unexpected(steps.error());
    for (std::size_t tick = 0; tick < from_.steps; ++tick) {
      const auto step = steps->next();
      if (!step) return tl::unexpected(step.error());
      if (tick == 0) look_at_first((*step)->sample);
      if (!found_) continue;
      Sample completed = (*step)->sample;
      complete(completed);
      found_->next(completed, {setpoint_.next(completed), (*step)->setpoint_us});
    }
    for (const PairedOutput& output : steps->outputs()) outputs_.push_back(output.logged());
    return {};
  }

  void look_at_first(const Sample& step) {
    const Module module = from_.log.module();
    SetpointKnown setpoint(module, from_.rules);
    setpoint.next(step);
    begins_with_mode_ = setpoint.has_mode();
    begins_in_flight_ = from_.rules == LogRules::cascade && is_in_flight(module, step);
    resets_before_ = step.attitude_in.vehicle_attitude.quat_reset_counter;
  }

  // Adds to the next tick what a log does not say in the samples of its topics.
  void complete(Sample& step) {
    if (from_.rules == LogRules::cascade && from_.log.module() == Module::attitude_unit) {
      auto& counter = step.attitude_in.vehicle_attitude.quat_reset_counter;
      counter = static_cast<std::uint8_t>(counter - resets_before_);
    }
    while (next_update_ < updates_.size() && updates_[next_update_] <= tick_) {
      if (updates_[next_update_++] > 0) set_value(update_, step, 1);
    }
    ++tick_;
  }

  LoggedModule from_;
  ChannelSet present_;
  std::vector<LoggedOutput> outputs_;
  std::shared_ptr<SingleStepFinder> found_;
  std::vector<std::size_t> updates_;  // the ticks of the log's changes of parameters
  const Channel& update_;
  bool leaves_out_ = false;  // samples
  bool begins_with_mode_ = false;
  bool begins_in_flight_ = false;
  std::uint8_t resets_before_ = 0;

  // The next tick.
  std::size_t tick_ = 0;
  std::size_t next_update_ = 0;
  std::optional<LoggedSteps> steps_;
  SetpointKnown setpoint_;
};

}  // namespace

Result<LoggedUnit> unit_of_log(ModuleContents log, const Sample& first, LogRules rules,
                               bool finds_steps, const std::string& file) {
  const auto ticks = TicksOfLog::open(std::move(log), first, rules, finds_steps, file);
  if (!ticks) return tl::unexpected(ticks.error());
  LoggedUnit unit;
  (*ticks)->describe(unit);
  unit.ticks = *ticks;
  return unit;
}

}  // namespace attest::ulog
