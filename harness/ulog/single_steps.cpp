#include "harness/ulog/single_steps.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "harness/ulog/candidate_steps.hpp"

namespace attest {
namespace {

using ulog::Candidate;
using ulog::Candidates;
using ulog::Thrust;

// Tells from the thrust up to which age setpoints were in use.
class Ages {
 public:
  void add(const Candidate& step) {
    const bool is_new = !last_ || last_->first != step.setpoint_us;
    if (is_new) has_new_thrust_ = last_ && !ulog::same_bits(last_->second, step.given);
    last_ = {step.setpoint_us, step.given};
    Count& count = counts_[std::min(step.age_us, oldest_age_us) / width_us];
    if (!step.has_same_thrust()) {
      ++count.other;
    } else {
      ++count.same;
      if (has_new_thrust_) ++count.with_new_thrust;
    }
  }

  // The greatest age up to which the thrust shows the logged setpoints to be those in use, but for
  // 1%. oldest_age_us if no thrust shows anything.
  std::uint64_t limit_us() const {
    std::uint64_t limit = 0;
    bool shows = false;
    std::size_t with_new_thrust = 0, other = 0;
    for (const auto& [bin, count] : counts_) {
      with_new_thrust += count.with_new_thrust;
      other += count.other;
      shows = shows || count.with_new_thrust > 0 || count.other > 0;
      if (count.with_new_thrust > 0 && 100 * other <= with_new_thrust + other)
        limit = (bin + 1) * width_us;
    }
    return shows ? limit : oldest_age_us;
  }

  // The steps with a younger setpoint: those with the same thrust, and the others.
  std::pair<std::size_t, std::size_t> counts_up_to(std::uint64_t limit_us) const {
    std::pair<std::size_t, std::size_t> sums;
    for (const auto& [bin, count] : counts_) {
      if ((bin + 1) * width_us > limit_us) break;
      sums.first += count.same;
      sums.second += count.other;
    }
    return sums;
  }

 private:
  struct Count {
    std::size_t same = 0, other = 0;  // steps with the thrust of the setpoint, and without
    std::size_t with_new_thrust =
        0;  // of `same`: the thrust differs from that of the setpoint before
  };
  static constexpr std::uint64_t width_us = 100, oldest_age_us = 10'000'000;

  std::map<std::uint64_t, Count> counts_;                 // by age, in units of width_us
  std::optional<std::pair<std::uint64_t, Thrust>> last_;  // setpoint: its time and thrust
  bool has_new_thrust_ =
      false;  // whether the thrust of the last setpoint differs from the one before
};

// The candidates of a unit, in memory if they are few. Otherwise the ticks are read again each
// time.
class CandidateReader {
 public:
  explicit CandidateReader(const LoggedUnit& log) : log_(log), ticks_(ticks_of(log)) {}

  // The next candidate is then the first one. Call it first.
  Result<void> rewind() {
    next_in_memory_ = 0;
    if (has_all_) return {};
    in_memory_.clear();
    fits_ = true;
    candidates_.emplace(log_);
    part_.samples.clear();
    at_ = tick_ = 0;
    has_ended_ = false;
    return ticks_->rewind();
  }

  // Empty after the last one.
  Result<std::optional<Candidate>> next() {
    if (has_all_) return next_in_memory();
    auto found = read_next();
    if (!found) return found;
    if (!*found) has_all_ = fits_;
    if (*found && fits_) in_memory_.push_back({**found, tick_});
    if (in_memory_.size() > most_in_memory) {
      in_memory_.clear();
      fits_ = false;
    }
    return found;
  }

  // The number of ticks up to the last candidate, included.
  std::size_t ticks() const { return tick_; }
  const Candidates& candidates() const { return *candidates_; }
  const std::string& file() const { return ticks_->file(); }

 private:
  struct InMemory {
    Candidate candidate;
    std::size_t ticks;
  };
  // 8 MB. The default log of half an hour has fewer.
  static constexpr std::size_t most_in_memory = 20'000;

  std::optional<Candidate> next_in_memory() {
    if (next_in_memory_ == in_memory_.size()) return std::nullopt;
    const InMemory& next = in_memory_[next_in_memory_++];
    tick_ = next.ticks;
    return next.candidate;
  }

  Result<std::optional<Candidate>> read_next() {
    while (true) {
      while (at_ < part_.samples.size()) {
        const std::size_t at = at_++;
        ++tick_;
        auto found = candidates_->next(part_.samples[at], ticks_->setpoints()[at]);
        if (found) return found;
      }
      if (has_ended_) return std::nullopt;
      if (auto read = read_part(); !read) return tl::unexpected(read.error());
    }
  }

  Result<void> read_part() {
    constexpr std::size_t most = 1024;
    at_ = 0;
    auto read = ticks_->next_part(most, part_);
    has_ended_ = part_.samples.size() < most;
    return read;
  }

  const LoggedUnit& log_;
  std::shared_ptr<LoggedTicks> ticks_;
  std::optional<Candidates> candidates_;
  std::vector<InMemory> in_memory_;
  bool fits_ = true, has_all_ = false;  // in memory
  std::size_t next_in_memory_ = 0;
  Trace part_;
  std::size_t at_ = 0;  // in part_, of the next tick
  std::size_t tick_ = 0;
  bool has_ended_ = false;
};

class SingleStepTicks final : public LoggedTicks {
 public:
  static Result<std::shared_ptr<SingleStepTicks>> open(const LoggedUnit& log) {
    std::shared_ptr<SingleStepTicks> made(new SingleStepTicks(log));
    const auto opened =
        made->count().and_then([&] { return made->place_parameters(); }).and_then([&] {
          return made->rewind();
        });
    if (!opened) return tl::unexpected(opened.error());
    return made;
  }

  const std::string& file() const override { return reader_.file(); }
  const ChannelSet& present() const override { return present_; }

  Result<void> rewind() override {
    tick_ = 0;
    return reader_.rewind();
  }

  Result<void> next_part(std::size_t most, Trace& part) override {
    part.source = file();
    part.present = present_;
    part.samples.clear();
    setpoints_.clear();
    const std::size_t first = tick_;
    while (part.samples.size() < most) {
      const auto step = next();
      if (!step) return tl::unexpected(step.error());
      if (!*step) break;
      part.samples.push_back((*step)->sample);
      setpoints_.push_back({Known::all, (*step)->setpoint_us, (*step)->has_own_setpoint});
    }
    part.parameters = changes_in(parameters_, first, part.samples.size());
    return {};
  }

  const SingleSteps& steps() const { return steps_; }
  const std::vector<ParameterChange>& parameters() const { return parameters_; }

 private:
  explicit SingleStepTicks(const LoggedUnit& log) : log_(log), reader_(log) {
    present_ = channels_of(log.module, "in/").set(timestamp_channel);
    const auto laws =
        log.module == Module::rate_unit
            ? std::vector{"vehicle_torque_setpoint", "vehicle_thrust_setpoint", "rate_ctrl_status"}
            : std::vector{"vehicle_rates_setpoint"};
    for (const char* topic : laws) {
      present_ |= channels_of(log.module, fmt::format("out/{}.", topic)) & log.trace.present;
    }
    parameters_ = log.trace.parameters;
  }

  // The next single step; empty after the last one.
  Result<std::optional<Candidate>> next() {
    while (true) {
      auto step = reader_.next();
      if (!step || !*step) return step;
      if (!is_in_use(**step)) continue;
      ++tick_;
      return step;
    }
  }

  bool is_in_use(const Candidate& step) const {
    return step.has_same_thrust() && (step.has_own_setpoint || step.age_us < steps_.oldest_us);
  }

  // Finds out which setpoints were in use, and counts the steps.
  Result<void> count() {
    if (auto begun = rewind(); !begun) return begun;
    Ages ages;
    std::size_t candidates = 0, other_own = 0;
    while (true) {
      const auto step = reader_.next();
      if (!step) return tl::unexpected(step.error());
      if (!*step) break;
      ++candidates;
      if (!(*step)->has_own_setpoint)
        ages.add(**step);
      else if ((*step)->has_same_thrust())
        ++steps_.with_own_setpoint;
      else
        ++other_own;
    }
    steps_.oldest_us = ages.limit_us();
    const auto [fit, other] = ages.counts_up_to(steps_.oldest_us);
    steps_.with_given_setpoint = fit;
    describe(reader_.candidates(), candidates - steps_.with_own_setpoint - fit, other + other_own);
    return {};
  }

  void describe(const Candidates& candidates, std::size_t unused, std::size_t other_thrust) {
    const auto add = [&](std::size_t outputs, std::string why) {
      if (outputs > 0) steps_.left_out.push_back({std::move(why), outputs});
    };
    const bool is_rate_unit = log_.module == Module::rate_unit;
    const auto* const topic = is_rate_unit ? "rate_ctrl_status" : "vehicle_rates_setpoint";
    for (const LoggedOutput& output : log_.outputs) {
      if (output.topic != topic) continue;
      steps_.logged = output.samples + output.other_wings;
      add(output.samples - std::min(output.samples, candidates.outputs()),
          fmt::format("of a step whose {} the log does not have",
                      is_rate_unit ? "gyro sample or torque" : "attitude"));
      add(output.other_wings, "in fixed-wing flight or a transition");
    }
    for (const auto& [why, outputs] : candidates.unfit()) {
      add(outputs, text_of(why));
    }
    add(other_thrust, "with the thrust of another setpoint");
    add(unused - other_thrust,
        fmt::format("with a setpoint older than {:.1f} ms, which may not be the one in use",
                    static_cast<double>(steps_.oldest_us) / 1e3));
  }

  // Changes of parameters have the tick of the first single step after them.
  Result<void> place_parameters() {
    if (parameters_.empty() || parameters_.back().tick == 0) return {};
    if (auto begun = rewind(); !begun) return begun;
    std::size_t next_change = 0;
    const auto place_until = [&](std::size_t end, std::size_t tick) {
      for (; next_change < parameters_.size() && parameters_[next_change].tick < end;
           ++next_change) {
        parameters_[next_change].tick = tick;
      }
    };
    while (true) {
      const auto step = next();
      if (!step) return tl::unexpected(step.error());
      if (!*step) break;
      place_until(reader_.ticks(), tick_ - 1);
    }
    parameters_.resize(next_change);  // the others come after the last step
    return {};
  }

  const LoggedUnit& log_;
  CandidateReader reader_;
  ChannelSet present_;
  SingleSteps steps_;
  std::size_t tick_ = 0;  // of the next single step
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
  unit.single_steps = (*ticks)->steps();
  unit.ticks = *ticks;
  return unit;
}

}  // namespace attest
