#include "harness/verify/evaluate_log.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "harness/casefile/parse.hpp"
#include "harness/host/host_here.hpp"
#include "harness/port/builtin.hpp"
#include "harness/port/profiles.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

constexpr std::string_view memoryless = "vehicle_rates_setpoint";

void leave_out_parameters_of_others(const std::string& profile, Trace& trace) {
  const auto own = parameter_names(Module::mc_att_control, profile);
  std::erase_if(trace.parameters, [&](const ParameterChange& change) {
    return std::find(own.begin(), own.end(), change.name) == own.end();
  });
}

// `inputs` with the reference's outputs. Without them if the reference refuses the inputs: then no
// deviation from the log is explained.
Trace answered_by_reference(Trace inputs, const std::string& profile) {
  HostHere reference(open_builtin());
  if (const auto fault = reference.drive({profile}, inputs)) {
    for (Sample& sample : inputs.samples) sample.clear_outputs();
  }
  return inputs;
}

std::string why_it_fails(const TopicAgreement& topic, const LogLimits& limits) {
  if (topic.paired == 0) return fmt::format("no sample of {} answers a control_state", topic.topic);
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

}  // namespace

LogResult evaluate_log(const FlightLog& log, const std::string& profile, PortHost& host,
                       const LogLimits& limits) {
  LogResult found{result_for(log.trace, profile), {}, log.trace};
  CaseResult& result = found.result;
  leave_out_parameters_of_others(profile, found.got);
  for (Sample& sample : found.got.samples) sample.clear_outputs();
  if (declines(host.says(), result)) return found;
  const Trace reference = answered_by_reference(found.got, profile);
  if (const auto fault = host.drive({profile}, found.got)) {
    found.got.keep_first(fault->tick);
    judge(*fault, result);
    return found;
  }
  result.ticks = log.trace.samples.size();
  found.topics = agreement_with_log(found.got, log.trace, reference, limits);
  for (TopicAgreement& topic : found.topics) {
    topic.is_judged = log.has_every_step || topic.topic == memoryless;
    const bool is_non_finite = topic.non_finite > 0;  // wrong after any earlier steps
    if (!is_non_finite && (!topic.is_judged || topic.agrees(limits))) continue;
    if (result.verdict != Verdict::non_finite) {
      result.verdict = is_non_finite ? Verdict::non_finite : Verdict::fail;
      result.reason =
          result.reason.empty() || is_non_finite ? why_it_fails(topic, limits) : result.reason;
    }
  }
  const auto is_judged = [](const TopicAgreement& topic) { return topic.is_judged; };
  if (std::none_of(found.topics.begin(), found.topics.end(), is_judged)) {
    result.verdict = Verdict::skip;
    result.reason =
        "the log has no vehicle_rates_setpoint and not every step, so no output of it "
        "can be computed";
  }
  return found;
}

}  // namespace attest
