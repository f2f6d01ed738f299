#include "harness/diagnosis/hunt_shrink.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/baseline.hpp"

namespace attest {
namespace {

// A shrunk case of some tens of inputs needs about 300. A program may be slow.
constexpr int most_attempts = 1500;

class Shrinker {
 public:
  Shrinker(const HuntTarget& target, ShrunkTrial best, const HostOptions& options)
      : target_(target), best_(std::move(best)), options_(options) {}

  Result<ShrunkTrial> shrunk() {
    // Each attempt would cost the time limit.
    if (best_.failure.verdict == Verdict::timeout) return best_;
    cut_end();
    for (int pass = 0; pass < 3 && !error_; ++pass) {
      const std::size_t before = size();
      fewer_ticks();
      plain_times();
      fewer_parameters();
      plain_topics();
      plain_fields();
      if (size() == before) break;
    }
    round_values();
    if (error_) return tl::unexpected(*error_);
    return best_;
  }

 private:
  std::size_t size() const { return best_.inputs.ticks.size() + best_.inputs.parameters.size(); }

  // Keeps the candidate if it still fails in the same way.
  bool keeps(HuntInputs candidate) {
    if (error_ || attempts_ == most_attempts || candidate.ticks.empty()) return false;
    ++attempts_;
    make_orderly(target_.lacks, candidate);
    if (auto ready = ensure_host(host_, options_); !ready) {
      error_ = ready.error();
      return false;
    }
    auto trial = judge_trial(candidate, target_, *host_);
    if (makes_one_instance(target_)) host_.reset();
    if (!trial) {
      error_ = trial.error();
      return false;
    }
    if (!trial->failure || !fail_the_same_way(*trial->failure, best_.failure)) return false;
    best_ = {std::move(candidate), *std::move(trial->failure)};
    return true;
  }

  // Removes the ticks after the first deviation.
  void cut_end() {
    if (!best_.failure.first) return;
    HuntInputs candidate = best_.inputs;
    const std::size_t last = tick_of_step(candidate, best_.failure.first->tick);
    candidate.ticks.resize(last + 1);
    std::erase_if(candidate.parameters,
                  [&](const ParameterChange& change) { return change.tick > last; });
    keeps(std::move(candidate));
  }

  void fewer_ticks() {
    for (std::size_t length = best_.inputs.ticks.size() / 2; length > 0; length /= 2) {
      for (std::size_t begin = 0; begin < best_.inputs.ticks.size();) {
        if (!keeps(without(begin, begin + length))) begin += length;
      }
    }
  }

  HuntInputs without(std::size_t begin, std::size_t end) const {
    HuntInputs shorter = best_.inputs;
    end = std::min(end, shorter.ticks.size());
    shorter.ticks.erase(shorter.ticks.begin() + static_cast<std::ptrdiff_t>(begin),
                        shorter.ticks.begin() + static_cast<std::ptrdiff_t>(end));
    for (ParameterChange& change : shorter.parameters) {
      if (change.tick >= end) {
        change.tick -= end - begin;
      } else if (change.tick > begin) {
        change.tick = begin;
      }
    }
    std::erase_if(shorter.parameters, [&](const ParameterChange& change) {
      return change.tick > 0 && change.tick >= shorter.ticks.size();
    });
    return shorter;
  }

  void plain_times() {
    HuntInputs candidate = best_.inputs;
    for (HuntTick& tick : candidate.ticks) tick.periods = 1;
    keeps(candidate);
    candidate = best_.inputs;
    for (HuntTick& tick : candidate.ticks) tick.quiet = 0;
    keeps(candidate);
    for (std::size_t i = 0; i < best_.inputs.ticks.size(); ++i) shrink_gap(i);
    candidate = best_.inputs;
    candidate.start_us = HuntInputs().start_us;
    if (!target_.fixed_step) keeps(candidate);
  }

  void shrink_gap(std::size_t tick) {
    for (std::uint32_t HuntTick::*const gap : {&HuntTick::quiet, &HuntTick::periods}) {
      const std::uint32_t least = gap == &HuntTick::quiet ? 0 : 1;
      for (std::uint32_t now = best_.inputs.ticks[tick].*gap; now > least;) {
        HuntInputs candidate = best_.inputs;
        candidate.ticks[tick].*gap = now = std::max(least, now / 2);
        if (!keeps(std::move(candidate))) break;
      }
    }
  }

  void fewer_parameters() {
    HuntInputs candidate = best_.inputs;
    candidate.parameters.clear();
    if (keeps(std::move(candidate))) return;
    std::set<std::string> names;
    for (const ParameterChange& change : best_.inputs.parameters) names.insert(change.name);
    for (const std::string& name : names) {
      candidate = best_.inputs;
      std::erase_if(candidate.parameters,
                    [&](const ParameterChange& change) { return change.name == name; });
      if (keeps(std::move(candidate))) continue;
      candidate = best_.inputs;
      std::erase_if(candidate.parameters, [&](const ParameterChange& change) {
        return change.name == name && change.tick > 0;
      });
      if (keeps(std::move(candidate))) continue;
    }
  }

  // Topics that are published at the first tick only, with baseline values.
  void plain_topics() {
    const Sample plain = baseline_sample(target_.subject.module);
    for (const HuntTopic& topic : hunt_topics(target_.subject.module)) {
      HuntInputs candidate = best_.inputs;
      for (HuntTick& tick : candidate.ticks) {
        topic.copy(plain, tick.sample);
        if (topic.bit != 0) tick.sample.in.updated &= ~topic.bit;
      }
      if (topic.bit != 0) candidate.ticks.front().sample.in.updated |= topic.bit;
      if (keeps(std::move(candidate)) || topic.bit == 0) continue;
      for (std::size_t i = 1; i < best_.inputs.ticks.size(); ++i) {
        candidate = best_.inputs;
        if (!topic.is_new(candidate.ticks[i].sample)) continue;
        candidate.ticks[i].sample.in.updated &= ~topic.bit;
        keeps(std::move(candidate));
      }
    }
  }

  // Fields with the baseline at all ticks, or else with one value at all ticks.
  void plain_fields() {
    const Sample plain = baseline_sample(target_.subject.module);
    for (const HuntTopic& topic : hunt_topics(target_.subject.module)) {
      for (std::size_t i = 0; i < topic.fields.size(); ++i) {
        const bool is_rotation = topic.fields[i]->quantity == Quantity::quaternion;
        const std::size_t count = is_rotation ? 4 : 1;
        const auto fields = std::span(topic.fields).subspan(i, count);
        i += count - 1;
        if (is_plain(fields, plain) || keeps(with(fields, plain))) continue;
        if (keeps(with(fields, best_.inputs.ticks.back().sample))) continue;
        keeps(with(fields, best_.inputs.ticks.front().sample));
      }
    }
  }

  bool is_plain(std::span<const Channel* const> fields, const Sample& plain) const {
    return std::ranges::all_of(best_.inputs.ticks, [&](const HuntTick& tick) {
      return std::ranges::all_of(
          fields, [&](const Channel* field) { return same_bits(*field, tick.sample, plain); });
    });
  }

  HuntInputs with(std::span<const Channel* const> fields, const Sample& from) const {
    HuntInputs candidate = best_.inputs;
    for (HuntTick& tick : candidate.ticks) {
      for (const Channel* field : fields) copy_value(*field, from, tick.sample);
    }
    return candidate;
  }

  // Numbers with few digits are easier to read.
  void round_values() {
    for (const int digits : {1, 2, 3}) {
      for (const HuntTopic& topic : hunt_topics(target_.subject.module)) {
        for (const Channel* field : topic.fields) {
          if (field->type != ChannelType::f32 || field->quantity == Quantity::quaternion) continue;
          round(*field, digits);
        }
      }
    }
  }

  void round(const Channel& field, int digits) {
    HuntInputs candidate = best_.inputs;
    bool differs = false;
    for (HuntTick& tick : candidate.ticks) {
      const float value = float_of(field, tick.sample);
      const bool is_plain = value == static_cast<float>(baseline(field));
      if (!std::isfinite(value) || is_plain) continue;
      set_value(field, tick.sample, std::stod(fmt::format("{:.{}g}", value, digits)));
      differs = differs || value != float_of(field, tick.sample);
    }
    if (differs) keeps(std::move(candidate));
  }

  const HuntTarget& target_;
  ShrunkTrial best_;
  const HostOptions& options_;
  std::unique_ptr<PortHost> host_;
  std::optional<Error> error_;
  int attempts_ = 0;
};

}  // namespace

bool fail_the_same_way(const VectorResult& one, const VectorResult& other) {
  if (one.verdict != other.verdict) return false;
  if (one.first.has_value() != other.first.has_value()) return false;
  return !one.first || one.first->channel == other.first->channel;
}

Result<ShrunkTrial> shrink(const HuntTarget& target, HuntInputs inputs, VectorResult failed,
                           const HostOptions& options) {
  return Shrinker(target, {std::move(inputs), std::move(failed)}, options).shrunk();
}

}  // namespace attest
