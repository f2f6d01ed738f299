#include "harness/verify/declared_lacks.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/compare/compare.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/golden/reference.hpp"
#include "harness/port/profiles.hpp"
#include "harness/trace/output_topics.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

// The first value that differs from the constant; null if there is none.
const ParameterChange* other_value(std::span<const ParameterChange> changes,
                                   const ConstantParameter& constant) {
  const auto found = std::ranges::find_if(changes, [&](const ParameterChange& change) {
    return change.name == constant.name && change.value != constant.value;
  });
  return found == changes.end() ? nullptr : &*found;
}

bool sets(std::span<const ParameterChange> changes, const ConstantParameter& constant) {
  return std::ranges::find(changes, constant.name, &ParameterChange::name) != changes.end();
}

bool is_default(const ConstantParameter& constant, const ModuleUnderTest& subject) {
  const ProfileInfo* const profile = find_profile(subject.profile);
  if (!profile) return true;
  const auto known = parameters_of(subject.module, *profile);
  const auto found = std::ranges::find(known, constant.name, &Parameter::name);
  return found == known.end() || found->default_value == constant.value;
}

}  // namespace

bool adds_constants(const Lacks& lacks, const ModuleUnderTest& subject, const Trace& inputs,
                    std::vector<ParameterChange>& parameters, VectorResult& result) {
  const std::vector<ParameterChange> given = parameters;
  for (const ConstantParameter& constant : lacks.constants) {
    const ParameterChange set{0, constant.name, constant.value};
    if (!check_parameter(subject, set)) continue;  // of another module
    const auto& in_force = sets(given, constant) ? given : inputs.parameters;
    if (const ParameterChange* const other = other_value(in_force, constant)) {
      result.verdict = Verdict::unsupported;
      result.reason = fmt::format("{} is {} in the port, and this vector sets {}", constant.name,
                                  constant.value, other->value);
      result.lacking = {constant.name};
      return false;
    }
    // Also if the inputs set it: until then they have the default.
    if (!sets(given, constant) && !is_default(constant, subject)) parameters.push_back(set);
  }
  return true;
}

FeatureSet lacking_features(const Lacks& lacks, const Trace& inputs,
                            const ModuleUnderTest& subject) {
  if (lacks.features.none()) return {};
  FeatureSet used = features_of(inputs, subject.profile);
  if (subject.instances != Instances::one) used |= only(Feature::instances);
  return lacks.features & used;
}

void leave_out(const FeatureSet& lacking, VectorResult& result) {
  if (lacking.none() || !is_judged(result.verdict)) return;
  const std::vector<std::string> names = names_of(lacking);
  VectorResult left_out;
  left_out.profile = result.profile;
  left_out.group = result.group;
  left_out.name = result.name;
  left_out.rate = result.rate;
  left_out.plant_configuration = result.plant_configuration;
  left_out.elapsed_s = result.elapsed_s;
  left_out.verdict = Verdict::unsupported;
  left_out.reason = fmt::format("the port declares that it lacks {}", fmt::join(names, ", "));
  left_out.lacking = names;
  if (result.verdict == Verdict::pass && names.size() == 1) left_out.has_after_all = names;
  result = std::move(left_out);
}

void note_published(const Lacks& lacks, const Trace& answered, VectorResult& result) {
  for (const OutputTopic& topic : output_topics(module_of(answered.present))) {
    if (!lacks.outputs[topic.published]) continue;
    const Channel& flag = channels()[topic.published];
    const bool publishes = std::ranges::any_of(
        answered.samples, [&](const Sample& sample) { return is_published(flag, sample); });
    if (publishes) result.has_after_all.emplace_back(topic.name);
  }
}

namespace {

// The outputs of the module that a flight needs and the port lacks.
ChannelSet lacking_in_flight(const Lacks& lacks, Module module) {
  ChannelSet needed = channels_of(module, "out/");
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    // No other unit and no motor reads the integrals and the landing gear.
    const bool is_gear = channel.name.starts_with("out/actuator_controls_0.control[") &&
                         channel.name >= "out/actuator_controls_0.control[4]";
    if (channel.stage == Stage::integrator || is_gear) needed.reset(i);
  }
  return needed & lacks.outputs;
}

}  // namespace

bool excludes_flight(const Lacks& lacks, const Case& the_case, VectorResult& result) {
  ChannelSet needed = lacking_in_flight(lacks, the_case.module);
  if (the_case.attitude_loop) needed |= lacking_in_flight(lacks, Module::attitude_unit);
  if (needed.none()) return false;
  result.verdict = Verdict::unsupported;
  result.reason = fmt::format("the port declares that it lacks {}, which a flight needs",
                              names_of(needed).front());
  return true;
}

FeatureSet lacking_features(const Lacks& lacks, const Flown& flown, VectorResult& result) {
  FeatureSet lacking;
  for (const Trace* trace :
       {&flown.trace, flown.attitude_trace ? &*flown.attitude_trace : nullptr}) {
    if (trace == nullptr || trace->samples.empty()) continue;
    std::vector<ParameterChange> others;
    if (!adds_constants(lacks, {result.profile, module_of(trace->present)}, *trace, others, result))
      return {};
    if (!others.empty()) {
      result.verdict = Verdict::unsupported;
      result.reason = fmt::format("{} is {} in the port, and flights have its default",
                                  others.front().name, others.front().value);
      return {};
    }
    lacking |= lacking_features(lacks, *trace, {result.profile, module_of(trace->present)});
  }
  return lacking;
}

void try_constant(const ModuleUnderTest& subject, const Trace& inputs, const Tolerances& tolerances,
                  PortHost& host, VectorResult& result) {
  const Lacks& lacks = host.declarations().lacks;
  Trace with_constant = inputs;
  for (ParameterChange& change : with_constant.parameters) {
    if (change.name == result.lacking.front()) change.value = lacks.constant(change.name)->value;
  }
  const auto want = reference_outputs(subject, inputs);
  const auto constant = reference_outputs(subject, with_constant);
  if (!want || !constant || compare(*constant, *want, tolerances).agrees()) {
    result.lacking.clear();
    return;
  }
  Trace answered = inputs;
  for (Sample& sample : answered.samples) sample.clear_outputs();
  if (host.drive(subject, answered)) return;
  fill_in(lacks.outputs, *want, answered);
  if (compare(answered, *want, tolerances).agrees()) result.has_after_all = result.lacking;
}

std::vector<std::string> needless_lacks(const std::vector<VectorResult>& results) {
  std::set<std::string> had;
  std::map<std::string, bool> passes_always;  // of the features
  for (const VectorResult& result : results) {
    if (result.plant_configuration) continue;  // a flight that uses a feature is not flown
    if (result.lacking.empty()) {
      had.insert(result.has_after_all.begin(), result.has_after_all.end());
    } else if (result.lacking.size() == 1) {
      const auto [known, is_new] = passes_always.try_emplace(result.lacking.front(), true);
      known->second = known->second && !result.has_after_all.empty();
    }
  }
  for (const auto& [feature, passes] : passes_always) {
    if (passes) had.insert(feature);
  }
  return {had.begin(), had.end()};
}

}  // namespace attest
