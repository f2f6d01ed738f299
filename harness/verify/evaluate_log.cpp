#include "harness/verify/evaluate_log.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/golden/recorded.hpp"
#include "harness/golden/reference.hpp"
#include "harness/ulog/single_steps.hpp"
#include "harness/verify/controls_without_memory.hpp"
#include "harness/verify/evaluate_single_steps.hpp"
#include "harness/verify/judge.hpp"
#include "harness/verify/replayed_log.hpp"

namespace attest {
namespace {

// The output of the controller and of the attitude unit that depends on one sample only, unless the
// sticks make the setpoint (Known::if_every_step).
constexpr std::string_view memoryless = "vehicle_rates_setpoint";

bool has_memory(Module module, const TopicAgreement& topic) {
  return module == Module::rate_unit || topic.topic != memoryless;
}

std::string why_it_fails(const TopicAgreement& topic, const LogLimits& limits) {
  if (topic.non_finite > 0) {
    return fmt::format("NaN or infinity in {} samples of {} where the log has numbers",
                       topic.non_finite, topic.topic);
  }
  if (topic.mistakes > 0) {
    return fmt::format(
        "{} samples of {} are wrong: the reference agrees with the log there, and "
        "the port is off by more than {:g} or does not publish",
        topic.mistakes, topic.topic, 10 * limits.within);
  }
  if (topic.part_within() < limits.least_part_within) {
    return fmt::format("{:.1f}% of {} are within {:g}; at least {:g}% must be",
                       100 * topic.part_within(), topic.topic, limits.within,
                       100 * limits.least_part_within);
  }
  return fmt::format("{:.1f}% of {} are not explained; at most {:g}% may be",
                     100 * topic.part_unexplained(), topic.topic, 100 * limits.most_unexplained);
}

std::vector<bool> ticks_but(const std::vector<LoggedSetpoint>& ticks, Known most) {
  std::vector<bool> leaves_out;
  for (const LoggedSetpoint& setpoint : ticks) leaves_out.push_back(setpoint.known > most);
  return leaves_out;
}

bool has_integral(const Sample& sample) {
  const auto& status = sample.out.mc_att_ctrl_status;
  return status.roll_rate_integ != 0 || status.pitch_rate_integ != 0 || status.yaw_rate_integ != 0;
}

// Finds out which outputs of a log can judge a port.
class Comparable {
 public:
  // `of_reference`: how well the reference agrees with the log. Without topics, the log is not
  // compared with it.
  Comparable(const LoggedUnit& log, const LogLimits& limits,
             std::vector<TopicAgreement> of_reference)
      : log_(log), limits_(limits), of_reference_(std::move(of_reference)) {}

  bool agrees_with_reference(std::string_view topic) const {
    return std::all_of(of_reference_.begin(), of_reference_.end(), [&](const TopicAgreement& one) {
      return one.topic != topic || one.agrees(limits_);
    });
  }

  void set_not_judged(TopicAgreement& topic) const {
    topic.not_judged = why_not(topic);
    if (!topic.not_judged.empty()) return;
    topic.not_judged = why_unlike_reference(topic);
    topic.is_unlike_reference = !topic.not_judged.empty();
  }

 private:
  // Why the log has too little.
  std::string why_not(const TopicAgreement& topic) const {
    const bool needs_steps = has_memory(log_.module, topic);
    if (needs_steps && !log_.not_judged.empty()) return log_.not_judged;
    if (needs_steps && log_.module == Module::mc_att_control && !log_.has_every_step) {
      return "it depends on earlier steps, and the log does not have every step";
    }
    if (topic.paired == 0 && topic.left_out > 0) {
      return "it depends on earlier steps, or on a mode or setpoint that the log does not have, "
             "and "
             "the log does not have every step";
    }
    if (topic.paired == 0) {
      return fmt::format("for each logged sample of it, the {} or another input is not in the log",
                         log_.step_topic);
    }
    return "";
  }

  std::string why_unlike_reference(const TopicAgreement& topic) const {
    if (log_.has_every_step && log_.module == Module::mc_att_control) return "";
    // The topics of a rate unit are judged together, because its torque contains the integral.
    for (const TopicAgreement& one : of_reference_) {
      const bool concerns = one.topic == topic.topic || log_.module == Module::rate_unit;
      if (concerns && one.paired > 0 && !one.agrees(limits_)) return how_unlike_reference(one);
    }
    return "";
  }

  std::string how_unlike_reference(const TopicAgreement& topic) const {
    const char* const unknown =
        log_.module == Module::rate_unit ? "the integral and filters" : "filters and headings";
    const std::string why =
        log_.begins_in_flight
            ? fmt::format("the log begins in flight, where {} are not known", unknown)
            : "the log lacks samples that the unit had, what was assumed does not hold, or another "
              "law flew";
    return fmt::format("only {:.1f}% of the reference's {} are within {:g} of the log: {}",
                       100 * topic.part_within(), topic.topic, limits_.within, why);
  }

  const LoggedUnit& log_;
  const LogLimits& limits_;
  std::vector<TopicAgreement> of_reference_;
};

// Leaves the verdict of a port with a fault.
void judge_topics(const std::vector<TopicAgreement>& topics, const LogLimits& limits,
                  VectorResult& result) {
  if (result.verdict != Verdict::pass) return;
  for (const TopicAgreement& topic : topics) {
    const bool is_non_finite = topic.non_finite > 0;  // wrong also if earlier steps are not known
    if (!is_non_finite && (!topic.not_judged.empty() || topic.agrees(limits))) continue;
    if (result.verdict == Verdict::non_finite) continue;
    if (result.reason.empty() || is_non_finite) result.reason = why_it_fails(topic, limits);
    result.verdict = is_non_finite ? Verdict::non_finite : Verdict::fail;
  }
  const auto is_judged = [](const TopicAgreement& topic) { return topic.not_judged.empty(); };
  if (result.verdict != Verdict::pass || std::any_of(topics.begin(), topics.end(), is_judged)) {
    return;
  }
  result.verdict = Verdict::skip;
  result.reason = topics.empty() ? "the log has no output of it" : topics.front().not_judged;
}

// Gives the log to the reference and to a port.
class LogJudge {
 public:
  LogJudge(const LoggedUnit& log, ModuleUnderTest subject, const LogLimits& limits,
           const LogParameters& parameters, std::size_t most_ticks, const OpenHost& reference)
      : log_(log),
        ticks_(ticks_of(log)),
        subject_(std::move(subject)),
        limits_(limits),
        most_ticks_(most_ticks),
        parameters_(parameters),
        open_reference_(reference) {}

  // Compares the port at the ticks that the log shows well enough: also those that depend on every
  // step, if the reference agrees with them. Sets the topics and the ticks, or the verdict of a
  // port with a fault.
  Result<void> compare(PortHost& port, LogResult& found) {
    for (const Known most : {Known::if_every_step, Known::all}) {
      if (most == Known::if_every_step && !log_.has_every_step) continue;
      auto of_reference = drive(port, most, found);
      if (!of_reference) return tl::unexpected(of_reference.error());
      const Comparable comparable(log_, limits_, *std::move(of_reference));
      for (TopicAgreement& topic : found.topics) comparable.set_not_judged(topic);
      if (comparable.agrees_with_reference(memoryless)) break;
    }
    const bool judges_alone = !log_.has_every_step && !found.topics.empty() && !alone_.empty() &&
                              alone_of_reference_.front().paired >= least_steps &&
                              alone_of_reference_.front().agrees(limits_);
    if (judges_alone) found.topics.push_back(alone_.front());
    return {};
  }

 private:
  // Gives the ticks to the reference and to the port, and compares those of which at most this is
  // unknown. Returns how well the reference agrees with the log. Without topics: it cannot answer,
  // for example because it does not have the profile, or the port has a fault.
  Result<std::vector<TopicAgreement>> drive(PortHost& port, Known most, LogResult& found) {
    const auto host = open_reference_();
    ReplayedPort reference(*host, subject_, parameters_.as_flown);
    ReplayedPort judged(port, subject_, parameters_.of_port);
    LogAgreement of_reference(log_.trace.present, limits_), of_port(log_.trace.present, limits_);
    const ControlsWithoutMemory controls(log_, subject_.profile, parameters_);
    LogAgreement reference_alone(controls.channels, limits_),
        port_alone(controls.channels, limits_);
    bool is_integrating = false;
    std::optional<PortFault> fault;
    bool fails = false;  // the reference
    found.got.samples.clear();
    found.topics.clear();
    const auto ticks = for_each_part_of(
        *ticks_, most_ticks_, [&](const Trace& logged, std::size_t at, bool is_last) {
          Trace as_flown = reference.inputs(logged, at);
          fails = has_reference_ && reference.answer(as_flown, at, is_last);
          if (fails) return false;
          Trace got = judged.inputs(logged, at);
          fault = judged.answer(got, at, is_last);
          if (!log_.ticks) append(got, found.got);
          if (fault) return false;
          const auto leaves_out = ticks_but(ticks_->setpoints(), most);
          if (has_reference_) of_reference.add(as_flown, logged, as_flown, leaves_out);
          of_port.add(got, logged, as_flown, leaves_out);
          std::vector<bool> is_left_out = leaves_out;
          for (std::size_t i = 0; i < is_left_out.size(); ++i) {
            is_integrating = is_integrating || has_integral(as_flown.samples[i]);
            if (is_integrating) is_left_out[i] = true;
          }
          reference_alone.add(as_flown, logged, as_flown, is_left_out);
          port_alone.add(got, logged, as_flown, is_left_out);
          return true;
        });
    if (!ticks) return tl::unexpected(ticks.error());
    if (fails) {
      has_reference_ = false;
      return drive(port, most, found);
    }
    if (fault) {
      found.got.keep_first(fault->tick);
      judge(*fault, found.result);
      return std::vector<TopicAgreement>();
    }
    found.result.ticks = *ticks;
    found.topics = of_port.finish();
    alone_ = port_alone.finish();
    alone_of_reference_ = reference_alone.finish();
    for (TopicAgreement& topic : alone_) topic.condition = controls.condition;
    if (!has_reference_) alone_.clear();
    return has_reference_ ? of_reference.finish() : std::vector<TopicAgreement>();
  }

  static void append(const Trace& part, Trace& whole) {
    whole.samples.insert(whole.samples.end(), part.samples.begin(), part.samples.end());
  }

  const LoggedUnit& log_;
  std::shared_ptr<LoggedTicks> ticks_;
  ModuleUnderTest subject_;
  const LogLimits& limits_;
  std::size_t most_ticks_;
  const LogParameters& parameters_;
  const OpenHost& open_reference_;
  bool has_reference_ = true;                               // it can answer
  std::vector<TopicAgreement> alone_, alone_of_reference_;  // ControlsWithoutMemory
};

std::string why_no_step(const SingleSteps& steps, const std::string& not_judged) {
  const auto most =
      std::max_element(steps.left_out.begin(), steps.left_out.end(),
                       [](const auto& a, const auto& b) { return a.outputs < b.outputs; });
  std::string why = not_judged.empty() ? "" : not_judged + "; ";
  why += "no single step has all its inputs in the log";
  if (most == steps.left_out.end()) return why;
  return why + fmt::format(": {} of {} outputs are {}", most->outputs, steps.logged, most->why);
}

// The log as it is, tick by tick.
Result<void> compare_ticks(const LoggedUnit& log, const ModuleUnderTest& subject, PortHost& host,
                           const LogLimits& limits, const LogParameters& parameters,
                           std::size_t most_ticks, const OpenHost& reference, LogResult& found) {
  found.got.source = log.trace.source;
  found.got.present = log.trace.present;
  return LogJudge(log, subject, limits, parameters, most_ticks, reference).compare(host, found);
}

}  // namespace

std::unique_ptr<PortHost> open_the_reference() { return open_reference(); }

Result<LogResult> evaluate_log(const LoggedUnit& log, const std::string& profile, PortHost& host,
                               const LogLimits& limits, const std::vector<ParameterChange>& given,
                               std::size_t most_ticks, const OpenHost& reference) {
  const ModuleUnderTest subject{profile, log.module};
  const LogResult nothing{result_for(log.trace.source, profile), {}, {}, {}, {}};
  LogResult found = nothing;
  if (marks_declined(host.declarations(), found.result)) return found;
  if (!log.ticks && log.trace.samples.empty()) {
    found.result.verdict = Verdict::skip;
    found.result.reason = log.not_judged;
    return found;
  }
  const bool has_single_steps = info_of(log.module).is_of_cascade();
  if (!has_single_steps || log.not_judged.empty()) {
    const LogParameters parameters(log, subject, given);
    auto compared =
        compare_ticks(log, subject, host, limits, parameters, most_ticks, reference, found);
    if (!compared) return tl::unexpected(compared.error());
    judge_topics(found.topics, limits, found.result);
    if (found.result.verdict != Verdict::skip || !has_single_steps) return found;
  }
  const auto steps = single_steps_of(log);
  if (!steps) return tl::unexpected(steps.error());
  LogResult of_steps = nothing;
  const LogParameters parameters(*steps, subject, given);
  auto compared = compare_single_steps(*steps, subject, host, limits, parameters, most_ticks,
                                       !log.ticks, reference, of_steps);
  if (!compared) return tl::unexpected(compared.error());
  VectorResult& result = of_steps.result;
  if (result.verdict != Verdict::pass) return of_steps;  // the port has a fault
  judge_topics(of_steps.topics, limits, result);
  if (of_steps.topics.empty()) result.reason = why_no_step(*of_steps.single_steps, log.not_judged);
  const bool shows_more = result.verdict != Verdict::skip || found.result.reason.empty();
  return shows_more ? of_steps : found;
}

}  // namespace attest
