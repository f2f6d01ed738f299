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
#include "harness/port/profiles.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

// The output of the controller and of the attitude unit that depends on one sample only, unless the
// sticks make the setpoint (Known::if_every_step).
constexpr std::string_view memoryless = "vehicle_rates_setpoint";

bool has_memory(Module module, const TopicAgreement& topic) {
  return module == Module::rate_unit || topic.topic != memoryless;
}

using Parameters = std::vector<ParameterChange>;

Parameters without_those_of_others(const ModuleUnderTest& subject, Parameters parameters) {
  const auto own = parameter_names(subject.module, subject.profile);
  std::erase_if(parameters, [&](const ParameterChange& change) {
    return std::find(own.begin(), own.end(), change.name) == own.end();
  });
  return parameters;
}

// The log's parameters, with those that the port gets in their place.
Parameters parameters_of_port(const LoggedUnit& log, const Parameters& given) {
  Trace trace;
  trace.parameters = log.trace.parameters;
  for (const ParameterChange& change : given) override_parameter(change, trace);
  return trace.parameters;
}

// Returns `of_port`, in which the parameters that the log has get the log's values.
Parameters with_those_of_log(const LoggedUnit& log, const Parameters& of_port) {
  const auto& logged = log.trace.parameters;
  const auto is_logged = [&](const ParameterChange& change) {
    return std::any_of(logged.begin(), logged.end(),
                       [&](const ParameterChange& one) { return one.name == change.name; });
  };
  Parameters parameters;
  std::copy_if(of_port.begin(), of_port.end(), std::back_inserter(parameters),
               [&](const ParameterChange& change) { return !is_logged(change); });
  parameters.insert(parameters.end(), logged.begin(), logged.end());
  std::stable_sort(parameters.begin(), parameters.end(),
                   [](const auto& a, const auto& b) { return a.tick < b.tick; });
  return parameters;
}

template <typename Take>
Result<std::size_t> for_each_part_of(LoggedTicks& ticks, std::size_t most_ticks, Take take) {
  return ticks.rewind().and_then([&] { return for_each_part(ticks, most_ticks, take); });
}

// How well the reference agrees with a log; empty if it cannot answer.
using OfReference = std::optional<std::vector<TopicAgreement>>;

// An instance of a port that gets the inputs of a log.
class Replayed {
 public:
  Replayed(PortHost& host, ModuleUnderTest subject, const Parameters& parameters)
      : host_(host), subject_(std::move(subject)), parameters_(parameters) {}

  // The inputs of a part, without outputs.
  Trace inputs(const Trace& logged, std::size_t first_tick) const {
    Trace inputs = logged;
    inputs.parameters = changes_in(parameters_, first_tick, logged.samples.size());
    for (Sample& sample : inputs.samples) sample.clear_outputs();
    return inputs;
  }

  // Adds the outputs. The instance is made for the first part, and ends with the last.
  std::optional<PortFault> answer(Trace& inputs, std::size_t first_tick, bool is_last) {
    subject_.part = {first_tick, is_last};
    return host_.drive(subject_, inputs);
  }

 private:
  PortHost& host_;
  ModuleUnderTest subject_;
  const Parameters& parameters_;
};

std::string why_it_fails(const TopicAgreement& topic, const LogLimits& limits) {
  if (topic.non_finite > 0) {
    return fmt::format("NaN or infinity in {} samples of {} where the log has numbers",
                       topic.non_finite, topic.topic);
  }
  if (topic.part_within() < limits.least_part_within) {
    return fmt::format("{:.1f}% of {} are within {:g}; at least {:g}% must be",
                       100 * topic.part_within(), topic.topic, limits.within,
                       100 * limits.least_part_within);
  }
  return fmt::format("{:.1f}% of {} are not explained; at most {:g}% may be",
                     100 * topic.part_unexplained(), topic.topic, 100 * limits.most_unexplained);
}

std::vector<bool> ticks_but(const std::vector<Known>& ticks, Known most) {
  std::vector<bool> leaves_out;
  for (const Known known : ticks) leaves_out.push_back(known > most);
  return leaves_out;
}

// Finds out which ticks and which outputs of a log can judge a port.
class Comparable {
 public:
  // `reference(most)`: how well the reference agrees with the log at the ticks of which at most
  // this is unknown. Empty if the reference cannot answer; then the log is not compared with it.
  template <typename Reference>
  static Result<Comparable> of(const LoggedUnit& log, const LogLimits& limits,
                               Reference reference) {
    Comparable made(log, limits);
    for (const Known most : {Known::if_every_step, Known::all}) {
      if (most == Known::if_every_step && !log.has_every_step) continue;
      made.most_ = most;
      auto found = reference(most);
      if (!found) return tl::unexpected(found.error());
      made.take(*std::move(found));
      if (made.agrees_with_reference(memoryless)) break;
    }
    return made;
  }

  bool has_reference() const { return has_reference_; }

  // The ticks to leave out, of these.
  std::vector<bool> leaves_out(const std::vector<Known>& ticks) const {
    return ticks_but(ticks, most_);
  }

  std::string why_not(const TopicAgreement& topic) const {
    const bool needs_steps = has_memory(log_.module, topic);
    if (needs_steps && !log_.not_judged.empty()) return log_.not_judged;
    if (needs_steps && log_.module == Module::mc_att_control && !log_.has_every_step) {
      return "it depends on earlier steps, and the log does not have every step";
    }
    if (topic.paired == 0) {
      return fmt::format("for each logged sample of it, the {} or another input is not in the log",
                         log_.step_topic);
    }
    if (log_.has_every_step && log_.module == Module::mc_att_control) return "";
    // The topics of a rate unit are judged together, because its torque contains the integral.
    for (const TopicAgreement& one : of_reference_) {
      const bool concerns = one.topic == topic.topic || log_.module == Module::rate_unit;
      if (concerns && one.paired > 0 && !one.agrees(limits_)) return why_unlike_reference(one);
    }
    return "";
  }

 private:
  Comparable(const LoggedUnit& log, const LogLimits& limits) : log_(log), limits_(limits) {}

  void take(OfReference of_reference) {
    has_reference_ = of_reference.has_value();
    of_reference_ = std::move(of_reference).value_or(std::vector<TopicAgreement>());
  }

  std::string why_unlike_reference(const TopicAgreement& topic) const {
    const char* const why =
        log_.begins_in_flight
            ? "the log begins in flight, where the integral, filters or headings are not known"
            : "the log lacks samples that the unit had, what was assumed does not hold, or another "
              "law flew";
    return fmt::format("only {:.1f}% of the reference's {} are within {:g} of the log: {}",
                       100 * topic.part_within(), topic.topic, limits_.within, why);
  }

  const TopicAgreement* find(std::string_view topic) const {
    const auto found = std::find_if(of_reference_.begin(), of_reference_.end(),
                                    [&](const TopicAgreement& one) { return one.topic == topic; });
    return found == of_reference_.end() ? nullptr : &*found;
  }

  bool agrees_with_reference(std::string_view topic) const {
    const TopicAgreement* const found = find(topic);
    return found == nullptr || found->agrees(limits_);
  }

  const LoggedUnit& log_;
  const LogLimits& limits_;
  Known most_ = Known::all;
  bool has_reference_ = false;
  std::vector<TopicAgreement> of_reference_;
};

void judge_topics(const std::vector<TopicAgreement>& topics, const LogLimits& limits,
                  VectorResult& result) {
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
           const Parameters& given, std::size_t most_ticks)
      : log_(log),
        ticks_(ticks_of(log)),
        subject_(std::move(subject)),
        limits_(limits),
        most_ticks_(most_ticks),
        of_port_(without_those_of_others(subject_, parameters_of_port(log, given))),
        as_flown_(without_those_of_others(subject_, with_those_of_log(log, of_port_))) {}

  // Empty if the reference has a fault, for example because it does not have the profile.
  Result<OfReference> of_reference(Known most) {
    const auto host = open_reference();
    Replayed reference(*host, subject_, as_flown_);
    LogAgreement agreement(log_.trace.present, limits_);
    std::optional<PortFault> fault;
    const auto read = for_each_part_of(
        *ticks_, most_ticks_, [&](const Trace& logged, std::size_t at, bool is_last) {
          Trace answered = reference.inputs(logged, at);
          fault = reference.answer(answered, at, is_last);
          if (!fault) agreement.add(answered, logged, answered, ticks_but(ticks_->known(), most));
          return !fault;
        });
    if (!read) return tl::unexpected(read.error());
    if (fault) return std::nullopt;
    return agreement.finish();
  }

  // Sets the topics and the ticks, unless the port has a fault.
  Result<std::optional<PortFault>> drive(PortHost& port, const Comparable& comparable,
                                         LogResult& found) {
    const auto host = open_reference();
    Replayed reference(*host, subject_, as_flown_), judged(port, subject_, of_port_);
    LogAgreement agreement(log_.trace.present, limits_);
    std::optional<PortFault> fault;
    const auto ticks = for_each_part_of(
        *ticks_, most_ticks_, [&](const Trace& logged, std::size_t at, bool is_last) {
          Trace as_flown = reference.inputs(logged, at);
          if (comparable.has_reference()) reference.answer(as_flown, at, is_last);
          Trace got = judged.inputs(logged, at);
          fault = judged.answer(got, at, is_last);
          if (!log_.ticks) append(got, found.got);
          if (fault) return false;
          const auto leaves_out = comparable.leaves_out(ticks_->known());
          agreement.add(got, logged, as_flown, leaves_out);
          return true;
        });
    if (!ticks) return tl::unexpected(ticks.error());
    if (fault) {
      found.got.keep_first(fault->tick);
      return fault;
    }
    found.result.ticks = *ticks;
    found.topics = agreement.finish();
    return std::nullopt;
  }

 private:
  static void append(const Trace& part, Trace& whole) {
    whole.samples.insert(whole.samples.end(), part.samples.begin(), part.samples.end());
  }

  const LoggedUnit& log_;
  std::shared_ptr<LoggedTicks> ticks_;
  ModuleUnderTest subject_;
  const LogLimits& limits_;
  std::size_t most_ticks_;
  Parameters of_port_, as_flown_;
};

}  // namespace

Result<LogResult> evaluate_log(const LoggedUnit& log, const std::string& profile, PortHost& host,
                               const LogLimits& limits,
                               const std::vector<ParameterChange>& parameters,
                               std::size_t most_ticks) {
  LogResult found{result_for(log.trace.source, profile), {}, {}};
  VectorResult& result = found.result;
  if (marks_declined(host.declarations(), result)) return found;
  if (!log.ticks && log.trace.samples.empty()) {
    result.verdict = Verdict::skip;
    result.reason = log.not_judged;
    return found;
  }
  found.got.source = log.trace.source;
  found.got.present = log.trace.present;
  LogJudge judging(log, {profile, log.module}, limits, parameters, most_ticks);
  const auto comparable =
      Comparable::of(log, limits, [&](Known most) { return judging.of_reference(most); });
  if (!comparable) return tl::unexpected(comparable.error());
  const auto fault = judging.drive(host, *comparable, found);
  if (!fault) return tl::unexpected(fault.error());
  if (*fault) {
    judge(**fault, result);
    return found;
  }
  for (TopicAgreement& topic : found.topics) topic.not_judged = comparable->why_not(topic);
  judge_topics(found.topics, limits, result);
  return found;
}

}  // namespace attest
