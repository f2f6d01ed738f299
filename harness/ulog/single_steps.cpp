#include "harness/ulog/single_steps.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/ulog/single_step_maker.hpp"

namespace attest {
namespace {

using ulog::SingleStep;
using ulog::SingleStepMaker;

// Few steps stay in memory, and are then read once. 20,000 are 8 MB; the default log of half an
// hour has fewer.
constexpr std::size_t most_in_memory = 20'000;

class SingleStepTicks final : public LoggedTicks {
 public:
  static Result<std::shared_ptr<SingleStepTicks>> open(const LoggedUnit& log) {
    std::shared_ptr<SingleStepTicks> made(new SingleStepTicks(log));
    const auto opened = made->read_all().and_then([&] { return made->rewind(); });
    if (!opened) return tl::unexpected(opened.error());
    return made;
  }

  const std::string& file() const override { return ticks_->file(); }
  const ChannelSet& present() const override { return present_; }

  Result<void> rewind() override {
    step_ = 0;
    return has_all_ ? Result<void>() : rewind_file();
  }

  Result<void> next_part(std::size_t most, Trace& part) override {
    part.source = file();
    part.present = present_;
    part.samples.clear();
    setpoints_.clear();
    const std::size_t first = step_;
    while (part.samples.size() < most) {
      const auto step = next();
      if (!step) return tl::unexpected(step.error());
      if (!*step) break;
      part.samples.push_back((*step)->sample);
      setpoints_.push_back((*step)->setpoint);
    }
    part.parameters = changes_in(parameters_, first, part.samples.size());
    return {};
  }

  const SingleSteps& counts() const { return counts_; }
  const std::vector<ParameterChange>& parameters() const { return parameters_; }

 private:
  explicit SingleStepTicks(const LoggedUnit& log) : log_(log), ticks_(ticks_of(log)) {
    present_ = channels_of(log.module, "in/").set(timestamp_channel);
    const auto laws =
        log.module == Module::rate_unit
            ? std::vector{"vehicle_torque_setpoint", "vehicle_thrust_setpoint", "rate_ctrl_status"}
            : std::vector{"vehicle_rates_setpoint"};
    for (const char* topic : laws) {
      present_ |= channels_of(log.module, fmt::format("out/{}.", topic)) & log.trace.present;
    }
  }

  // Counts the steps, and keeps them if they are few. A change of a parameter gets the number of
  // the first single step after it.
  Result<void> read_all() {
    if (auto begun = rewind_file(); !begun) return begun;
    const std::vector<ParameterChange>& changes = log_.trace.parameters;
    bool fits = true;
    while (true) {
      const auto step = read_next();
      if (!step) return tl::unexpected(step.error());
      if (!*step) break;
      while (parameters_.size() < changes.size() && changes[parameters_.size()].tick < tick_) {
        parameters_.push_back(changes[parameters_.size()]);
        parameters_.back().tick = step_;
      }
      ++((*step)->setpoint.is_own ? counts_.with_own_setpoint : counts_.with_given_setpoint);
      ++step_;
      fits = step_ <= most_in_memory;
      if (fits) in_memory_.push_back(**step);
    }
    has_all_ = fits;
    if (!fits) in_memory_ = {};
    count_left_out();
    return {};
  }

  void count_left_out() {
    const auto add = [&](std::size_t outputs, std::string why) {
      if (outputs > 0) counts_.left_out.push_back({std::move(why), outputs});
    };
    const bool is_rate_unit = log_.module == Module::rate_unit;
    const auto* const topic = is_rate_unit ? "rate_ctrl_status" : "vehicle_rates_setpoint";
    for (const LoggedOutput& output : log_.outputs) {
      if (output.topic != topic) continue;
      counts_.logged = output.samples + output.other_wings;
      add(output.samples - std::min(output.samples, maker_->outputs()),
          fmt::format("of a step whose {} the log does not have",
                      is_rate_unit ? "gyro sample or torque" : "attitude"));
      add(output.other_wings, "in fixed-wing flight or a transition");
    }
    for (const auto& [why, outputs] : maker_->unfit()) add(outputs, text_of(why));
  }

  Result<std::optional<SingleStep>> next() {
    if (!has_all_) {
      auto step = read_next();
      if (step && *step) ++step_;
      return step;
    }
    return step_ < in_memory_.size() ? std::optional(in_memory_[step_++]) : std::nullopt;
  }

  Result<void> rewind_file() {
    maker_.emplace(log_);
    part_.samples.clear();
    at_ = tick_ = 0;
    has_ended_ = false;
    return ticks_->rewind();
  }

  // The next single step of the file; empty after the last one.
  Result<std::optional<SingleStep>> read_next() {
    constexpr std::size_t most = 1024;
    while (true) {
      while (at_ < part_.samples.size()) {
        const std::size_t at = at_++;
        ++tick_;
        auto step = maker_->next(part_.samples[at], ticks_->setpoints()[at]);
        if (step) return step;
      }
      if (has_ended_) return std::nullopt;
      at_ = 0;
      if (auto read = ticks_->next_part(most, part_); !read) return tl::unexpected(read.error());
      has_ended_ = part_.samples.size() < most;
    }
  }

  const LoggedUnit& log_;
  std::shared_ptr<LoggedTicks> ticks_;
  ChannelSet present_;
  SingleSteps counts_;
  std::vector<SingleStep> in_memory_;
  bool has_all_ = false;  // in memory
  std::size_t step_ = 0;  // the next one

  // The place in the file.
  std::optional<SingleStepMaker> maker_;
  Trace part_;
  std::size_t at_ = 0;    // in part_, of the next tick
  std::size_t tick_ = 0;  // the next one
  bool has_ended_ = false;
};

}  // namespace

Result<LoggedUnit> single_steps_of(const LoggedUnit& log) {
  const auto ticks = SingleStepTicks::open(log);
  if (!ticks) return tl::unexpected(ticks.error());
  LoggedUnit unit;
  unit.module = log.module;
  unit.step_topic = log.step_topic;
  unit.trace.source = log.trace.source;
  unit.trace.present = (*ticks)->present();
  unit.trace.parameters = (*ticks)->parameters();
  unit.outputs = log.outputs;
  unit.period_us = log.period_us;
  unit.single_steps = (*ticks)->counts();
  unit.ticks = *ticks;
  return unit;
}

}  // namespace attest
