#include "harness/verify/evaluate_single_steps.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "controller/cascade/profile.hpp"
#include "harness/core/agreement.hpp"
#include "harness/golden/reference.hpp"
#include "harness/verify/integral_in_use.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

constexpr std::uint64_t any_age = std::numeric_limits<std::uint64_t>::max();

// The outputs that the law computes from the inputs of the step alone.
ChannelSet compared_outputs(const LoggedUnit& steps, const std::string& profile) {
  ChannelSet compared = steps.trace.present;
  const Module module = steps.module;
  compared &= ~channels_of(module, "out/rate_ctrl_status.");
  const auto known = cascade::profile_from_name(profile);
  if (module == Module::rate_unit && (!known || cascade::traits_of(*known).filters_yaw_torque)) {
    compared.reset(*find_channel(module, "out/vehicle_torque_setpoint.xyz[2]"));
  }
  return compared;
}

// Why no step of the unit can be judged alone; empty if it can.
std::string remembers_setpoints(Module module, const std::string& profile) {
  const auto known = cascade::profile_from_name(profile);
  const bool remembers = module == Module::attitude_unit && known &&
                         cascade::traits_of(*known).follows_reference_model;
  return remembers ? fmt::format(
                         "the reference model of {} depends on all earlier setpoints, and "
                         "the log does not have every step",
                         profile)
                   : "";
}

// Finds the age up to which the setpoints of the log were in use: the reference agrees with the log
// only where they were.
class AgeLimit {
 public:
  void add(std::uint64_t age_us, bool agrees) {
    ++(agrees ? counts_[age_us / width_us].agree : counts_[age_us / width_us].differ);
    ++all_;
  }

  // any_age if there is no age up to which it agrees with all but this part of the steps.
  std::uint64_t limit_us(double most_unexplained) const {
    // A setpoint that is published every 4 ms and logged every 20 ms is in use in 1 of 5 steps. If
    // the reference agrees with fewer, this is by chance.
    constexpr std::size_t least_part = 5;
    std::uint64_t limit = any_age;
    std::size_t agree = 0, differ = 0;
    for (const auto& [bin, count] : counts_) {
      agree += count.agree;
      differ += count.differ;
      const auto steps = static_cast<double>(agree + differ);
      const bool are_enough = agree >= least_steps && agree * least_part >= all_;
      if (are_enough && static_cast<double>(differ) <= most_unexplained * steps) {
        limit = (bin + 1) * width_us;
      }
    }
    return limit;
  }

 private:
  struct Count {
    std::size_t agree = 0, differ = 0;
  };
  static constexpr std::uint64_t width_us = 100;  // a period of a loop is ten times as long

  std::map<std::uint64_t, Count> counts_;  // by age, in units of width_us
  std::size_t all_ = 0;
};

// The steps of one kind, in which port and reference are compared with the log.
struct StepKind {
  bool has_own_setpoint;
  std::string condition;
  std::size_t steps = 0;
  LogAgreement of_port, of_reference;
};

// On the ground the reference would not tell the increment of the integral. It begins each step at
// 0 nevertheless, because the vehicle is not armed.
void lift(Trace& inputs) {
  for (Sample& sample : inputs.samples) sample.rate_in.vehicle_land_detected = {0, 0};
}

Trace only(const Trace& all, const std::vector<bool>& wanted) {
  Trace some;
  for (std::size_t i = 0; i < all.samples.size(); ++i) {
    if (wanted[i]) some.samples.push_back(all.samples[i]);
  }
  return some;
}

void append(const Trace& part, Trace& whole) {
  whole.samples.insert(whole.samples.end(), part.samples.begin(), part.samples.end());
}

// Gives the steps to the port and to the reference.
class SingleStepJudge {
 public:
  SingleStepJudge(const LoggedUnit& steps, const ModuleUnderTest& subject, const LogLimits& limits,
                  const LogParameters& parameters, std::size_t most_ticks,
                  const OpenHost& reference)
      : steps_(steps),
        subject_(subject),
        limits_(limits),
        parameters_(parameters),
        most_ticks_(most_ticks),
        open_reference_(reference),
        compared_(compared_outputs(steps, subject.profile)) {
    for (const std::size_t i : outputs_by_stage(compared_)) outputs_.push_back(&channels()[i]);
  }

  // Finds out which steps are compared, with the reference alone.
  Result<void> find_steps() {
    AgeLimit ages;
    const auto host = open_reference_();
    ReplayedPort reference(*host, subject_, parameters_.as_flown);
    IntegralInUse integral(steps_.period_us);
    const auto read = for_each_part_of(
        *steps_.ticks, most_ticks_, [&](const Trace& logged, std::size_t at, bool is_last) {
          Trace as_flown = inputs_of(reference, logged, at);
          has_reference_ = !reference.answer(as_flown, at, is_last);
          if (!has_reference_) return false;
          for (std::size_t i = 0; i < logged.samples.size(); ++i) {
            Sample want = logged.samples[i];
            remove_integral(integral, as_flown.samples[i], want);
            const LoggedSetpoint& setpoint = steps_.ticks->setpoints()[i];
            if (!setpoint.is_own)
              ages.add(age_of(want, setpoint), agree(as_flown.samples[i], want));
          }
          return true;
        });
    if (!read) return tl::unexpected(read.error());
    // Half, so that a right port that rounds in another way stays within the whole.
    if (has_reference_) oldest_us_ = ages.limit_us(limits_.most_unexplained / 2);
    return {};
  }

  // Sets the traces of `found` if they are wanted, and its verdict if the port has a fault.
  Result<void> compare(PortHost& port, bool keeps_traces, LogResult& found) {
    make_kinds();
    const auto host = open_reference_();
    ReplayedPort reference(*host, subject_, parameters_.as_flown);
    ReplayedPort judged(port, subject_, parameters_.of_port);
    IntegralInUse integral(steps_.period_us);
    found.want.source = found.got.source = steps_.trace.source;
    found.want.present = found.got.present = compared_;
    std::optional<PortFault> fault;
    const auto read = for_each_part_of(
        *steps_.ticks, most_ticks_, [&](const Trace& logged, std::size_t at, bool is_last) {
          Trace want = logged, as_flown = inputs_of(reference, logged, at);
          Trace got = judged.inputs(logged, at);
          if (has_reference_) reference.answer(as_flown, at, is_last);
          fault = judged.answer(got, at, is_last);
          for (std::size_t i = 0; i < want.samples.size(); ++i) {
            remove_integral(integral, as_flown.samples[i], want.samples[i]);
          }
          if (keeps_traces) append(want, found.want);
          if (keeps_traces) append(got, found.got);
          if (!fault) add(want, got, as_flown);
          return !fault;
        });
    if (!read) return tl::unexpected(read.error());
    if (fault) judge(*fault, found.result);
    for (const StepKind& kind : kinds_) found.result.ticks += kind.steps;
    return {};
  }

  std::vector<TopicAgreement> topics() {
    std::vector<TopicAgreement> all;
    for (StepKind& kind : kinds_) {
      if (kind.steps == 0) continue;
      const auto of_reference = kind.of_reference.finish();
      auto of_port = kind.of_port.finish();
      // Torque and thrust are judged together: the thrust is a copy, and shows little.
      std::string why = remembers_setpoints(subject_.module, subject_.profile);
      bool is_unlike_reference = false;
      for (std::size_t i = 0; i < of_port.size() && why.empty(); ++i) {
        why = why_not(of_port[i]);
        if (why.empty()) {
          why = why_unlike_reference(kind, of_reference[i]);
          is_unlike_reference = !why.empty();
        }
      }
      for (TopicAgreement& topic : of_port) {
        topic.condition = kind.condition;
        topic.not_judged = why;
        topic.is_unlike_reference = is_unlike_reference;
        all.push_back(std::move(topic));
      }
    }
    return all;
  }

  // Those that were compared.
  SingleSteps steps() const {
    SingleSteps steps = *steps_.single_steps;
    const std::size_t given = kinds_.front().steps;
    if (const std::size_t older = steps.with_given_setpoint - given; older > 0) {
      steps.left_out.push_back({fmt::format("with a setpoint of {:.1f} ms and more, with which the "
                                            "reference does not agree",
                                            static_cast<double>(oldest_us_) / 1e3),
                                older});
    }
    steps.with_given_setpoint = given;
    if (oldest_us_ != any_age) steps.oldest_us = oldest_us_;
    return steps;
  }

 private:
  Trace inputs_of(const ReplayedPort& reference, const Trace& logged, std::size_t at) const {
    Trace inputs = reference.inputs(logged, at);
    if (subject_.module == Module::rate_unit) lift(inputs);
    return inputs;
  }

  static std::uint64_t age_of(const Sample& step, const LoggedSetpoint& setpoint) {
    return step.in.timestamp - setpoint.time_us;
  }

  void make_kinds() {
    const auto agreement = [&] {
      return LogAgreement(compared_, limits_, LogAgreement::Neighbours::do_not_explain);
    };
    const std::string young =
        oldest_us_ == any_age
            ? "setpoint of any age"
            : fmt::format("setpoint younger than {:.1f} ms", static_cast<double>(oldest_us_) / 1e3);
    kinds_.push_back({false, young, 0, agreement(), agreement()});
    kinds_.push_back({true, "own setpoint of the step", 0, agreement(), agreement()});
  }

  void remove_integral(IntegralInUse& integral, const Sample& reference, Sample& logged) const {
    if (subject_.module == Module::rate_unit) integral.remove_from(logged, reference);
  }

  bool agree(const Sample& got, const Sample& want) const {
    return std::ranges::all_of(outputs_, [&](const Channel* output) {
      return distance(value_of(*output, got), value_of(*output, want)) <= limits_.within;
    });
  }

  std::string why_not(const TopicAgreement& of_port) const {
    if (of_port.paired < least_steps) {
      return fmt::format("the log has all inputs of only {} steps, and at least {} are needed",
                         of_port.paired, least_steps);
    }
    if (!has_reference_) {
      return fmt::format("attest does not have {}, so it cannot tell which setpoints were in use",
                         subject_.profile);
    }
    return "";
  }

  std::string why_unlike_reference(const StepKind& kind, const TopicAgreement& of_reference) const {
    if (of_reference.agrees(limits_)) return "";
    return fmt::format("only {:.1f}% of the reference's {} are within {:g} of the log{}",
                       100 * of_reference.part_within(), of_reference.topic, limits_.within,
                       kind.has_own_setpoint
                           ? ", although all inputs of these steps are known: another law flew, or "
                             "a modified one"
                           : ": another law flew, or a modified one, or the logged setpoints were "
                             "no longer in use");
  }

  void add(const Trace& want, const Trace& got, const Trace& as_flown) {
    for (StepKind& kind : kinds_) {
      std::vector<bool> is_of_kind;
      for (std::size_t i = 0; i < want.samples.size(); ++i) {
        const LoggedSetpoint& setpoint = steps_.ticks->setpoints()[i];
        const bool is_young = age_of(want.samples[i], setpoint) < oldest_us_;
        is_of_kind.push_back(setpoint.is_own == kind.has_own_setpoint &&
                             (setpoint.is_own || is_young));
      }
      const auto steps =
          static_cast<std::size_t>(std::count(is_of_kind.begin(), is_of_kind.end(), true));
      kind.steps += steps;
      if (steps == 0) continue;
      const Trace wanted = only(want, is_of_kind), reference = only(as_flown, is_of_kind);
      kind.of_port.add(only(got, is_of_kind), wanted, reference);
      kind.of_reference.add(reference, wanted, reference);
    }
  }

  const LoggedUnit& steps_;
  const ModuleUnderTest& subject_;
  const LogLimits& limits_;
  const LogParameters& parameters_;
  std::size_t most_ticks_;
  const OpenHost& open_reference_;
  ChannelSet compared_;
  std::vector<const Channel*> outputs_;  // of these
  std::uint64_t oldest_us_ = any_age;    // setpoints that were given are younger
  bool has_reference_ = false;           // false: attest does not have the law
  std::vector<StepKind> kinds_;
};

}  // namespace

Result<void> compare_single_steps(const LoggedUnit& steps, const ModuleUnderTest& subject,
                                  PortHost& port, const LogLimits& limits,
                                  const LogParameters& parameters, std::size_t most_ticks,
                                  bool keeps_traces, const OpenHost& reference, LogResult& found) {
  SingleStepJudge judging(steps, subject, limits, parameters, most_ticks, reference);
  const auto compared =
      judging.find_steps().and_then([&] { return judging.compare(port, keeps_traces, found); });
  const bool has_fault = found.result.verdict != Verdict::pass;
  if (!compared || has_fault) return compared;
  found.topics = judging.topics();
  found.single_steps = judging.steps();
  return {};
}

}  // namespace attest
