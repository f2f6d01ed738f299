#include "harness/verify/evaluate_log.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/golden/recorded.hpp"
#include "harness/host/host_here.hpp"
#include "harness/port/builtin.hpp"
#include "harness/port/profiles.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

// The output of the controller and of the attitude unit that depends on one sample only, unless the
// sticks make the setpoint (Known::if_every_step).
constexpr std::string_view memoryless = "vehicle_rates_setpoint";

bool has_memory(Module module, const TopicAgreement& topic) {
  return module == Module::rate_unit || topic.topic != memoryless;
}

void leave_out_parameters_of_others(const Subject& subject, Trace& trace) {
  const auto own = parameter_names(subject.module, subject.profile);
  std::erase_if(trace.parameters, [&](const ParameterChange& change) {
    return std::find(own.begin(), own.end(), change.name) == own.end();
  });
}

void set_parameters(const std::vector<ParameterChange>& parameters, Trace& trace) {
  for (const ParameterChange& change : parameters) override_parameter(change, trace);
}

// Returns `got`, in which the parameters that the log has get the log's values.
Trace with_parameters_of_log(const LoggedUnit& log, Trace got) {
  const auto& logged = log.trace.parameters;
  const auto is_logged = [&](const ParameterChange& change) {
    return std::any_of(logged.begin(), logged.end(),
                       [&](const ParameterChange& one) { return one.name == change.name; });
  };
  std::vector<ParameterChange> parameters;
  std::copy_if(got.parameters.begin(), got.parameters.end(), std::back_inserter(parameters),
               [&](const ParameterChange& change) { return !is_logged(change); });
  parameters.insert(parameters.end(), logged.begin(), logged.end());
  std::stable_sort(parameters.begin(), parameters.end(),
                   [](const auto& a, const auto& b) { return a.tick < b.tick; });
  got.parameters = std::move(parameters);
  return got;
}

// Adds the reference's outputs to the inputs. If the reference has a fault, for example because it
// does not have the profile, returns false and clears all outputs.
bool answer_by_reference(const Subject& subject, Trace& inputs) {
  HostHere reference(open_builtin());
  const bool has_answered = !reference.drive(subject, inputs);
  if (!has_answered) {
    for (Sample& sample : inputs.samples) sample.clear_outputs();
  }
  return has_answered;
}

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

std::vector<bool> ticks_but(const LoggedUnit& log, Known most) {
  std::vector<bool> leaves_out;
  for (const Known known : log.known) leaves_out.push_back(known > most);
  return leaves_out;
}

// Finds out which ticks and which outputs of a log can judge a port.
class Comparable {
 public:
  // `reference`: the log's inputs with the reference's outputs. If it is null, the log is not
  // compared with the reference.
  Comparable(const LoggedUnit& log, const Trace* reference, const LogLimits& limits)
      : log_(log), limits_(limits) {
    if (log.has_every_step) {
      leaves_out_ = ticks_but(log, Known::if_every_step);
      compare_reference(reference);
      if (agrees_with_reference(memoryless)) return;
    }
    leaves_out_ = ticks_but(log, Known::all);
    compare_reference(reference);
  }

  const std::vector<bool>& leaves_out() const { return leaves_out_; }

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
  void compare_reference(const Trace* reference) {
    if (reference == nullptr) return;
    of_reference_ = agreement_with_log(*reference, log_.trace, *reference, limits_, leaves_out_);
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
  std::vector<bool> leaves_out_;
  std::vector<TopicAgreement> of_reference_;
};

void judge_topics(const std::vector<TopicAgreement>& topics, const LogLimits& limits,
                  CaseResult& result) {
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

}  // namespace

LogResult evaluate_log(const LoggedUnit& log, const std::string& profile, PortHost& host,
                       const LogLimits& limits, const std::vector<ParameterChange>& parameters) {
  LogResult found{result_for(log.trace.source, profile), {}, log.trace};
  CaseResult& result = found.result;
  const Subject subject{profile, log.module};
  set_parameters(parameters, found.got);
  leave_out_parameters_of_others(subject, found.got);
  for (Sample& sample : found.got.samples) sample.clear_outputs();
  if (declines(host.says(), result)) return found;
  if (log.trace.samples.empty()) {
    result.verdict = Verdict::skip;
    result.reason = log.not_judged;
    return found;
  }
  Trace as_flown = with_parameters_of_log(log, found.got);
  leave_out_parameters_of_others(subject, as_flown);
  const bool has_reference = answer_by_reference(subject, as_flown);
  if (const auto fault = host.drive(subject, found.got)) {
    found.got.keep_first(fault->tick);
    judge(*fault, result);
    return found;
  }
  result.ticks = log.trace.samples.size();
  const Comparable comparable(log, has_reference ? &as_flown : nullptr, limits);
  found.topics =
      agreement_with_log(found.got, log.trace, as_flown, limits, comparable.leaves_out());
  for (TopicAgreement& topic : found.topics) topic.not_judged = comparable.why_not(topic);
  judge_topics(found.topics, limits, result);
  return found;
}

}  // namespace attest
