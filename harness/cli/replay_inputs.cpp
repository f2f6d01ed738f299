#include "harness/cli/replay_inputs.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/cli/outputs.hpp"
#include "harness/cli/read_log.hpp"

namespace attest::cli {
namespace {

Result<void> set_parameters(const ReplayOptions& options, RecordedParts& trace) {
  for (const std::string& parameter : options.parameters) {
    const auto change = parse_parameter(parameter);
    if (!change) return fail(fmt::format("--param {}: {}", parameter, change.error().message));
    if (auto checked = check_parameter(trace.subject(), *change); !checked) {
      return fail(fmt::format("--param {}: {}", parameter, checked.error().message));
    }
    trace.override_parameter(*change);
  }
  return {};
}

Result<void> check_parameters(const ReplayOptions& options, const FlightLog& log) {
  for (const std::string& parameter : options.parameters) {
    const auto change = parse_parameter(parameter);
    if (!change) return fail(fmt::format("--param {}: {}", parameter, change.error().message));
    std::string wrong;
    const auto has_it = [&](const LoggedUnit& unit) {
      const auto checked = check_parameter({log.profile, unit.module}, *change);
      if (!checked && wrong.empty()) wrong = checked.error().message;
      return checked.has_value();
    };
    if (std::none_of(log.units.begin(), log.units.end(), has_it)) {
      return fail(fmt::format("--param {}: {}", parameter, wrong));
    }
  }
  return {};
}

}  // namespace

bool is_replayed(const FileFormat& format) { return format.open || format.read_log; }

Result<RecordedParts> recorded_in(const std::string& file, const ReplayOptions& options) {
  auto recorded = RecordedParts::open(file, options.profile, options.mixer);
  if (!recorded) return recorded;
  if (auto set = set_parameters(options, *recorded); !set) return tl::unexpected(set.error());
  return recorded;
}

std::vector<ParameterChange> parameters_of(const ReplayOptions& options, const FlightLog& log,
                                           const LoggedUnit& unit) {
  std::vector<ParameterChange> changes;
  for (const std::string& parameter : options.parameters) {
    auto change = parse_parameter(parameter);
    if (change && check_parameter({log.profile, unit.module}, *change)) {
      changes.push_back(*std::move(change));
    }
  }
  return changes;
}

Result<FlightLog> log_in(const std::string& file, const ReplayOptions& options, bool whole) {
  if (!options.mixer.empty()) return fail_at(file, "is no mixer trace; leave --mixer out");
  auto log = read_any_log(file, options.assumed, options.profile, whole);
  if (!log || !log->no_profile.empty()) return log;
  if (auto checked = check_parameters(options, *log); !checked) {
    return tl::unexpected(checked.error());
  }
  return log;
}

}  // namespace attest::cli
