#include "harness/verify/replayed_log.hpp"

#include <algorithm>
#include <iterator>

#include "harness/golden/recorded.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

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

}  // namespace

LogParameters::LogParameters(const LoggedUnit& log, const ModuleUnderTest& subject,
                             const Parameters& given)
    : of_port(without_those_of_others(subject, parameters_of_port(log, given))),
      as_flown(without_those_of_others(subject, with_those_of_log(log, of_port))) {}

Trace ReplayedPort::inputs(const Trace& logged, std::size_t first_tick) const {
  Trace inputs = logged;
  inputs.parameters = changes_in(parameters_, first_tick, logged.samples.size());
  for (Sample& sample : inputs.samples) sample.clear_outputs();
  return inputs;
}

}  // namespace attest
