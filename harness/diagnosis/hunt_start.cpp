#include "harness/diagnosis/hunt_start.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include "harness/casefile/stimulus.hpp"

namespace attest {
namespace {

constexpr std::size_t most_ticks_of_case = 1000;  // of a trial
// So many ticks without news stay ticks, which a hunt varies; the ticks after them are quiet ones.
constexpr std::size_t most_plain_ticks = 32;

class Cutter {
 public:
  Cutter(const Trace& trace, HuntInputs about)
      : trace_(trace), module_(about.subject.module), about_(std::move(about)) {}

  std::vector<HuntInputs> cut() {
    for (step_ = 0; step_ < trace_.samples.size(); ++step_) add_step();
    return std::move(trials_);
  }

 private:
  const Sample& sample() const { return trace_.samples[step_]; }

  void add_step() {
    const bool is_first = trials_.empty() || trials_.back().ticks.size() == most_ticks_of_case;
    if (is_first) begin_trial();
    HuntTick tick = tick_of_step(is_first);
    const bool changes = add_parameters(is_first);
    if (!is_first && !changes && is_plain(tick)) {
      if (plain_ == most_plain_ticks) {
        ++trials_.back().ticks.back().quiet;
        return;
      }
      ++plain_;
    } else {
      plain_ = 0;
    }
    trials_.back().ticks.push_back(tick);
  }

  void begin_trial() {
    begin_us_ = sample().in.timestamp;
    trials_.push_back(about_);
    // Only a unit has a start in its case.
    if (info_of(module_).is_unit()) trials_.back().start_us = begin_us_;
  }

  // The period whose begin, in whole microseconds, is the time of the step.
  std::int64_t period(std::size_t step) const {
    const std::uint64_t time_us =
        trace_.samples[step].in.timestamp - trace_.samples.front().in.timestamp;
    return about_.rate.ticks_in(Nanoseconds{(static_cast<std::int64_t>(time_us) + 1) * 1000}) - 1;
  }

  HuntTick tick_of_step(bool is_first) {
    HuntTick tick;
    published_ |= sample().in.updated;
    const std::uint32_t news = is_first ? published_ : sample().in.updated;
    for (const HuntTopic& topic : hunt_topics(module_)) {
      if (topic.bit != 0 && (news & topic.bit) == 0) continue;
      topic.copy(sample(), tick.sample);
      tick.sample.in.updated |= topic.bit;
      for (const Channel* time : topic.times) {
        const std::uint64_t from = is_from_first_tick(*time) ? begin_us_ : sample().in.timestamp;
        set_relative_us(*time, tick.sample,
                        static_cast<std::int64_t>(integer_of(*time, sample()) - from));
      }
    }
    if (!is_first) {
      const std::int64_t periods = period(step_) - period(step_ - 1);
      tick.periods = static_cast<std::uint32_t>(std::max<std::int64_t>(periods, 1));
    }
    return tick;
  }

  // Whether the tick has no news since the last one.
  bool is_plain(const HuntTick& tick) const {
    const HuntTick& last = trials_.back().ticks.back();
    if (tick.sample.in.updated != 0 || tick.periods != 1) return false;
    return std::ranges::all_of(hunt_topics(module_), [&](const HuntTopic& topic) {
      return topic.bit != 0 || topic.has_same(last.sample, tick.sample);
    });
  }

  // True if a parameter changes at this step.
  bool add_parameters(bool is_first) {
    bool changes = false;
    for (; change_ < trace_.parameters.size(); ++change_) {
      const ParameterChange& change = trace_.parameters[change_];
      if (change.tick > step_) break;
      values_[change.name] = change.value;
      if (is_first) continue;
      trials_.back().parameters.push_back({trials_.back().ticks.size(), change.name, change.value});
      changes = true;
    }
    if (!is_first) return changes;
    for (const auto& [name, value] : values_) trials_.back().parameters.push_back({0, name, value});
    return true;
  }

  const Trace& trace_;
  const Module module_;
  const HuntInputs about_;
  std::vector<HuntInputs> trials_;
  std::size_t step_ = 0, change_ = 0;
  std::size_t plain_ = 0;  // ticks without news, at the end of the trial
  std::uint64_t begin_us_ = 0;
  std::uint32_t published_ = 0;          // topics, up to this step
  std::map<std::string, float> values_;  // of parameters, up to this step
};

}  // namespace

std::vector<HuntInputs> trials_of_case(const Case& the_case, const Rate& rate) {
  HuntInputs about;
  about.subject = subject_of(the_case);
  about.subject.instances = Instances::one;
  about.rate = rate;
  return Cutter(stimulate(the_case, rate), about).cut();
}

}  // namespace attest
