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
using ulog::SingleStepFinder;
using ulog::SingleStepMaker;

constexpr std::size_t ticks_of_part = 1024;

class SingleStepTicks final : public LoggedTicks {
 public:
  static Result<std::shared_ptr<SingleStepTicks>> open(const LoggedUnit& log) {
    std::shared_ptr<SingleStepTicks> made(new SingleStepTicks(log));
    const auto opened = made->find_all().and_then([&] { return made->rewind(); });
    if (!opened) return tl::unexpected(opened.error());
    return made;
  }

  const std::string& file() const override { return ticks_->file(); }
  const ChannelSet& present() const override { return present_; }

  Result<void> rewind() override {
    step_ = 0;
    return found_->has_all() ? Result<void>() : rewind_file();
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

  // Finds the steps, unless the log was read with them.
  Result<void> find_all() {
    found_ = log_.found_steps;
    if (!found_) {
      const auto found = std::make_shared<SingleStepFinder>(log_.module, log_.trace.parameters);
      const auto read = ticks_->rewind().and_then([&] {
        return for_each_part(*ticks_, ticks_of_part, [&](const Trace& ticks, std::size_t, bool) {
          for (std::size_t i = 0; i < ticks.samples.size(); ++i) {
            found->next(ticks.samples[i], ticks_->setpoints()[i]);
          }
          return true;
        });
      });
      if (!read) return tl::unexpected(read.error());
      found_ = found;
    }
    parameters_ = found_->parameters();
    counts_.with_own_setpoint = found_->with_own_setpoint();
    counts_.with_given_setpoint = found_->with_given_setpoint();
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
      add(output.samples - std::min(output.samples, found_->maker().outputs()),
          fmt::format("of a step whose {} the log does not have",
                      is_rate_unit ? "gyro sample or torque" : "attitude"));
      add(output.other_wings, "in fixed-wing flight or a transition");
    }
    for (const auto& [why, outputs] : found_->maker().unfit()) add(outputs, text_of(why));
  }

  Result<std::optional<SingleStep>> next() {
    if (!found_->has_all()) {
      auto step = read_next();
      if (step && *step) ++step_;
      return step;
    }
    const auto& all = found_->in_memory();
    return step_ < all.size() ? std::optional(all[step_++]) : std::nullopt;
  }

  Result<void> rewind_file() {
    maker_.emplace(log_.module, log_.trace.parameters);
    part_.samples.clear();
    at_ = 0;
    has_ended_ = false;
    return ticks_->rewind();
  }

  // The next single step of the file; empty after the last one.
  Result<std::optional<SingleStep>> read_next() {
    while (true) {
      while (at_ < part_.samples.size()) {
        const std::size_t at = at_++;
        auto step = maker_->next(part_.samples[at], ticks_->setpoints()[at]);
        if (step) return step;
      }
      if (has_ended_) return std::nullopt;
      at_ = 0;
      if (auto read = ticks_->next_part(ticks_of_part, part_); !read)
        return tl::unexpected(read.error());
      has_ended_ = part_.samples.size() < ticks_of_part;
    }
  }

  const LoggedUnit& log_;
  std::shared_ptr<LoggedTicks> ticks_;
  ChannelSet present_;
  SingleSteps counts_;
  std::shared_ptr<const SingleStepFinder> found_;
  std::size_t step_ = 0;  // the next one

  // The place in the file.
  std::optional<SingleStepMaker> maker_;
  Trace part_;
  std::size_t at_ = 0;  // in part_, of the next tick
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
