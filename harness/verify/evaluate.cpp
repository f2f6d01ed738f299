#include "harness/verify/evaluate.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/events.hpp"
#include "harness/golden/expected_outputs.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/golden/reference.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/verify/declared_lacks.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/judge.hpp"
#include "harness/verify/reference_comparison.hpp"
#include "harness/verify/saved_traces.hpp"
#include "harness/verify/silent_topics.hpp"
#include "harness/verify/stopwatch.hpp"

namespace attest {
namespace {

// Judges a comparison in open loop. A port in fixed point may take the other branch of a decision
// that its numbers do not resolve. If all ticks before such a decision agree, and a later one
// deviates, the vector is skipped. NaN and infinity are never excused.
void judge_outputs(const Comparison& comparison, const ModuleUnderTest& subject, const Trace& given,
                   const PortHost& host, Level level, VectorResult& result) {
  const auto bits = host.declarations().fraction_bits;
  const bool may_be_near =
      bits && level == Level::numeric && comparison.first && !comparison.got_non_finite;
  const auto near = may_be_near ? first_near_decision(subject, given, *bits, comparison.first->tick)
                                : std::nullopt;
  if (!near) return judge(comparison, result);
  result.verdict = Verdict::skip;
  result.compared.reset();
  result.reason = fmt::format(
      "nearer to a decision of the law than {} fraction bits resolve: {} at tick {}; the outputs "
      "deviate from tick {} on",
      *bits, name_of(near->decision), near->tick, comparison.first->tick);
}

// Drives a fresh unit through `answered`, which has the inputs of the vector, and judges its
// outputs. After a fault, `answered` keeps only the ticks before it.
void run_and_judge(Trace& answered, const Trace& want, const ModuleUnderTest& subject,
                   PortHost& host, const Tolerances& tolerances, const JudgeOptions& options,
                   VectorResult& result) {
  if (marks_declined(host.declarations(), result)) return;
  const Lacks& lacks = host.declarations().lacks;
  const auto fault = host.drive(subject, answered);
  if (!fault && lacks.outputs.any() && !leaves_values_to_judge(lacks.outputs, want)) {
    result.verdict = Verdict::unsupported;
    result.reason = "no value is left to judge: the others are 0, or the port lacks them";
    return;
  }
  if (!host.declarations().is_recorded) note_published(lacks, answered, result);
  const ChannelSet silent = options.leaves_out_silent && !fault
                                ? silent_outputs(answered, want, lacks.outputs, result)
                                : ChannelSet();
  fill_in(lacks.outputs | silent, want, answered);
  if (fault && !leaves_ticks_to_judge(*fault)) {
    judge(*fault, result);
  } else {
    if (fault) leave_out_from(fault->tick, want, answered);
    judge_outputs(compare(answered, want, tolerances), subject, answered, host, tolerances.level(),
                  result);
    if (host.declarations().is_recorded && fails_a_run(result.verdict)) {
      explain_recording(answered, want, result);
    }
    if (fault) judge_after(*fault, result);
  }
  if (fault) answered.keep_first(fault->tick);
  if (!saves_traces(options.save_traces, result)) return;
  save_traces(options.save_traces, subject, {answered, want, tolerances}, result);
}

// Runs a case that is compared at the exact level only at another level: its outputs are not
// judged, but the port must make all steps. It may refuse a parameter, because values such as NaN
// need not be allowed. The answers of a recorded port are outputs only.
void run_uncompared(Trace inputs, const ModuleUnderTest& subject, PortHost& host,
                    VectorResult& result) {
  if (marks_declined(host.declarations(), result)) return;
  if (!host.declarations().is_recorded) {
    const auto fault = host.drive(subject, inputs);
    if (fault && fault->kind != PortFault::Kind::refused) return judge(*fault, result);
  }
  result.verdict = Verdict::skip;
  result.reason = exact_level_only;
  result.exact_only = true;
}

// For a vector that gives a constant of the port another value, and is unsupported because of it.
// Only a vector that would be judged, and against the law, shows whether the port has the
// parameter.
void try_constant_of(const Case& the_case, const Trace& inputs, const Golden& golden,
                     PortHost& host, VectorResult& result) {
  const Declarations& port = host.declarations();
  const ModuleUnderTest subject = subject_of(the_case);
  const bool may_run = !port.is_recorded && !golden.is_of_port() && !the_case.exact_only &&
                       !marks_declined(port, the_case.group) &&
                       lacking_features(port.lacks, inputs, subject).none();
  if (!may_run) return result.lacking.clear();
  const Tolerances tolerances =
      tolerances_of(the_case, Level::numeric, port.fraction_bits, inputs.samples.size());
  try_constant(subject, inputs, tolerances, host, result);
}

// The expected outputs for `inputs`, which differ from those of the golden: they have the times for
// a port with a fixed step (fixed_step.hpp), or other parameters. Errors: the reference does not
// agree with the golden of `the_case`.
Result<ExpectedOutputs> expected_outputs_of_varied(const Case& the_case, const Rate& rate,
                                                   const Golden& golden, Trace inputs) {
  const auto checked = expected_outputs(the_case, rate, golden);
  if (!checked || golden.is_of_port()) {
    const char* const why = checked ? "the golden is of a port"
                                    : "the reference of this attest does not agree with the golden";
    return fail_at(
        the_case.file.string(),
        fmt::format("at {}, {}, so the expected outputs at other times or with other "
                    "parameters are not known{}",
                    rate.label(), why, checked ? "" : ": " + checked.error().to_string()));
  }
  auto outputs = reference_outputs(subject_of(the_case), std::move(inputs));
  if (!outputs) return tl::unexpected(outputs.error());
  return ExpectedOutputs{*std::move(outputs), checked->is_exact};
}

tl::unexpected<Error> other_bits(const Case& the_case, const Rate& rate) {
  return fail_at(the_case.file.string(),
                 fmt::format("at {}, the reference has other bits on this machine than the golden, "
                             "so bits cannot be compared; run at --level numeric",
                             rate.label()));
}

// Leaves out the parameters that the subject does not have, or whose value it cannot have.
std::vector<ParameterChange> accepted_by(const ModuleUnderTest& subject,
                                         std::vector<ParameterChange> parameters) {
  std::erase_if(parameters, [&](const ParameterChange& parameter) {
    return !check_parameter(subject, parameter).has_value();
  });
  return parameters;
}

}  // namespace

VectorResult result_for(const Case& the_case, const RunConfiguration& configuration) {
  VectorResult result;
  result.profile = the_case.profile;
  result.group = the_case.group;
  result.name = the_case.name;
  result.rate = configuration.rate;
  result.plant_configuration = configuration.plant_configuration;
  return result;
}

VectorResult result_for(const std::string& recorded, const std::string& profile) {
  VectorResult result;
  result.profile = profile;
  result.name = recorded;
  return result;
}

Result<VectorResult> evaluate_case(const Case& the_case, const Rate& rate, const Golden& golden,
                                   PortHost& host, const JudgeOptions& options) {
  const Stopwatch stopwatch;
  Level level = options.level;
  VectorResult result = result_for(the_case, {rate, std::nullopt});
  if (has_other_steps(host.declarations(), the_case, rate, result)) return result;
  const Lacks& lacks = host.declarations().lacks;
  auto parameters = accepted_by(subject_of(the_case), options.parameters);
  const auto inputs = [&] { return inputs_for(host.declarations(), the_case, rate, parameters); };
  if (!lacks.constants.empty() &&
      !adds_constants(lacks, subject_of(the_case), inputs(), parameters, result)) {
    try_constant_of(the_case, inputs(), golden, host, result);
    return result;
  }
  const FeatureSet lacking =
      lacks.features.any() ? lacking_features(lacks, inputs(), subject_of(the_case)) : FeatureSet();
  if (the_case.exact_only && level != Level::exact) {
    run_uncompared(inputs(), subject_of(the_case), host, result);
    leave_out(lacking, result);
    result.elapsed_s = stopwatch.elapsed_s();
    return result;
  }
  const bool is_varied = has_fixed_step(host.declarations(), the_case) || !parameters.empty();
  const auto expected = is_varied ? expected_outputs_of_varied(the_case, rate, golden, inputs())
                                  : expected_outputs(the_case, rate, golden);
  if (!expected) return tl::unexpected(expected.error());
  if (level == Level::events && !has_events(the_case.module)) level = Level::numeric;
  if (level == Level::exact && !expected->is_exact) return other_bits(the_case, rate);
  result.by_golden = !expected->is_exact;
  result.compared = level;
  const auto bits = host.declarations().fraction_bits;
  Trace answered = expected->trace;
  for (Sample& sample : answered.samples) sample.clear_outputs();
  const std::size_t ticks = answered.samples.size();
  run_and_judge(answered, expected->trace, subject_of(the_case), host,
                tolerances_of(the_case, level, bits, ticks), options, result);
  leave_out(lacking, result);
  result.elapsed_s = stopwatch.elapsed_s();
  return result;
}

namespace {

Tolerances tolerances_of_trace(const Tolerances& tolerances, Module module,
                               const Declarations& port, std::size_t ticks) {
  const bool numeric_for_events = tolerances.level() == Level::events && !has_events(module);
  Tolerances allowed = numeric_for_events ? Tolerances(Level::numeric) : tolerances;
  if (port.fraction_bits) allowed.allow_lsb(*port.fraction_bits, ticks);
  return allowed;
}

}  // namespace

void add_last_words(const PortHost& host, VectorResult& result) {
  const bool is_wrong = result.verdict == Verdict::fail || result.verdict == Verdict::non_finite;
  if (!is_wrong || !result.first) return;
  const std::string words = host.last_words();
  if (words.empty()) return;
  const std::string reason =
      result.reason.empty() ? std::string(meaning_of(result.verdict)) : result.reason;
  result.reason = fmt::format("{}; the port last printed: {}", reason, words);
}

VectorResult evaluate_trace(const Trace& recorded, const ModuleUnderTest& subject, PortHost& host,
                            const Tolerances& tolerances, Trace* got) {
  const Stopwatch stopwatch;
  VectorResult result = result_for(recorded.source, subject.profile);
  if (has_other_steps(host.declarations(), recorded, subject.module, result)) return result;
  Trace answered = recorded;
  for (Sample& sample : answered.samples) sample.clear_outputs();
  const Tolerances allowed =
      tolerances_of_trace(tolerances, subject.module, host.declarations(), recorded.samples.size());
  run_and_judge(answered, recorded, subject, host, allowed, {}, result);
  add_last_words(host, result);
  result.elapsed_s = stopwatch.elapsed_s();
  if (got != nullptr) *got = std::move(answered);
  return result;
}

namespace {

// For a port whose verdict depends on the whole trace before its first step: reads the trace, and
// returns the number of its ticks. For any other port returns 0.
Result<std::size_t> count_ticks(TraceParts& recorded, std::size_t most_ticks, Module module,
                                const Declarations& port, VectorResult& result) {
  if (!port.fraction_bits && !port.fixed_step) return 0;
  auto ticks =
      for_each_part(recorded, most_ticks, [&](const Trace& part, std::size_t first_tick, bool) {
        if (result.verdict == Verdict::pass)
          has_other_steps(port, part, module, result, first_tick);
        return true;
      });
  if (!ticks) return ticks;
  if (auto begun = recorded.rewind(); !begun) return tl::unexpected(begun.error());
  return ticks;
}

// Gives the parts to one instance, and compares them. After a fault, the rest of the trace is read
// for its errors only.
Result<Comparison> drive_parts(TraceParts& recorded, std::size_t most_ticks,
                               ModuleUnderTest subject, PortHost& host,
                               const Tolerances& tolerances, std::optional<PortFault>& fault) {
  const ChannelSet judged = recorded.present() & ~host.declarations().lacks.outputs;
  TickComparer comparer(judged, judged, tolerances);
  Trace answered;
  const auto ticks =
      for_each_part(recorded, most_ticks, [&](const Trace& want, std::size_t first, bool is_last) {
        answered = want;
        for (Sample& sample : answered.samples) sample.clear_outputs();
        subject.part = {first, is_last};
        if (!fault) fault = host.drive(subject, answered);
        if (fault) leave_out_from(std::max(fault->tick, first) - first, want, answered);
        comparer.add(answered, want);
        return true;
      });
  if (!ticks) return tl::unexpected(ticks.error());
  return comparer.finish(*ticks, *ticks);
}

}  // namespace

Result<VectorResult> evaluate_parts(TraceParts& recorded, const ModuleUnderTest& subject,
                                    PortHost& host, const Tolerances& tolerances,
                                    std::size_t most_ticks) {
  const Declarations& port = host.declarations();
  if (tolerances.level() == Level::events || port.is_recorded) {
    Trace whole;
    auto read = recorded.next_part(std::numeric_limits<std::size_t>::max(), whole);
    if (!read) return tl::unexpected(read.error());
    return evaluate_trace(whole, subject, host, tolerances);
  }
  const Stopwatch stopwatch;
  VectorResult result = result_for(recorded.file(), subject.profile);
  const auto ticks = count_ticks(recorded, most_ticks, subject.module, port, result);
  if (!ticks) return tl::unexpected(ticks.error());
  if (result.verdict != Verdict::pass || marks_declined(port, result)) return result;
  const Tolerances allowed = tolerances_of_trace(tolerances, subject.module, port, *ticks);
  std::optional<PortFault> fault;
  const auto compared = drive_parts(recorded, most_ticks, subject, host, allowed, fault);
  if (!compared) return tl::unexpected(compared.error());
  if (fault && !leaves_ticks_to_judge(*fault)) {
    judge(*fault, result);
  } else {
    judge(*compared, result);
    if (fault) judge_after(*fault, result);
  }
  add_last_words(host, result);
  result.elapsed_s = stopwatch.elapsed_s();
  return result;
}

}  // namespace attest
