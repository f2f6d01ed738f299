#include "harness/diagnosis/fault_job.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/diagnosis/hunt.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/port/fault_port.hpp"
#include "harness/trace/channels.hpp"
#include "harness/verify/evaluate.hpp"

namespace attest {
namespace {

// A vector. Those with a lower `turn` run first, because they are likelier to catch the fault.
struct Attempt {
  const Case* the_case;
  LoopRate rate;
  int turn;
};

std::vector<Attempt> attempts(const std::vector<SelectedCase>& cases, std::string_view group) {
  std::vector<Attempt> list;
  for (const auto& [the_case, configurations] : cases) {
    for (const RunConfiguration& configuration : configurations) {
      const int turn =
          (the_case.group == group ? 0 : 2) + (configuration.rate == Rate::hz(250) ? 0 : 1);
      list.push_back({&the_case, configuration.rate, turn});
    }
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const Attempt& a, const Attempt& b) { return a.turn < b.turn; });
  return list;
}

// A port on a unit of a log.
struct LoggedUnitResult {
  std::string_view title;  // of the unit
  VectorResult result;
  std::optional<std::size_t> tick = {};  // the first with a deviation
  bool is_unlike_reference = false;      // not judged, because the reference does not agree

  bool passes() const { return result.verdict == Verdict::pass; }
  bool fails() const { return fails_a_run(result.verdict); }

  // One line on a unit that does not pass.
  std::string reason() const {
    if (!result.first) return fmt::format("{}: {}", title, result.reason);
    return fmt::format("{}: differs from tick {} on, first in {}", title, result.first->tick,
                       channels()[result.first->channel].name);
  }
};

Result<LoggedUnitResult> judge_as_trace(const LoggedUnit& unit, const std::string& profile,
                                        PortHost& host) {
  const auto result =
      evaluate_parts(*ticks_of(unit), {profile, unit.module}, host, Tolerances(Level::numeric));
  if (!result) return tl::unexpected(result.error());
  LoggedUnitResult judged{info_of(unit.module).title, *result};
  if (result->first) judged.tick = result->first->tick;
  return judged;
}

// As `attest replay`, but with this reference. Errors: those of evaluate_log().
Result<std::vector<LoggedUnitResult>> judge_units(const FlightLog& log, PortHost& host,
                                                  const OpenHost& reference) {
  std::vector<LoggedUnitResult> results;
  if (log.is_like_trace()) {
    return judge_as_trace(log.units.front(), log.profile, host).map([](LoggedUnitResult one) {
      return std::vector<LoggedUnitResult>{std::move(one)};
    });
  }
  for (const LoggedUnit& unit : log.units) {
    const auto found = evaluate_log(unit, log.profile, host, {}, {}, ticks_at_once, reference);
    if (!found) return tl::unexpected(found.error());
    LoggedUnitResult judged{info_of(unit.module).title, found->result};
    for (const TopicAgreement& topic : found->topics) {
      if (!judged.tick && topic.first_unexplained) judged.tick = topic.first_unexplained->tick;
      const bool is_skipped = found->result.verdict == Verdict::skip;
      judged.is_unlike_reference |= is_skipped && topic.is_unlike_reference;
    }
    results.push_back(std::move(judged));
  }
  return results;
}

// Whether a port agrees with all units that the log shows.
Result<bool> agrees_with_log(const FlightLog& log, const OpenHost& open) {
  return judge_units(log, *open(), open).map([](const std::vector<LoggedUnitResult>& units) {
    return std::ranges::any_of(units, &LoggedUnitResult::passes) &&
           std::ranges::none_of(units, &LoggedUnitResult::fails) &&
           std::ranges::none_of(units, &LoggedUnitResult::is_unlike_reference);
  });
}

}  // namespace

std::string Codec<FaultCatch>::encode(const Result<FaultCatch>& result) {
  return attest::encode(result.map([](const FaultCatch& found) {
    nlohmann::json out = {{"verdict", name_of(found.verdict)}, {"by", found.by}};
    out["agrees_with_log"] = found.agrees_with_log;
    if (found.tick) out["tick"] = *found.tick;
    return out;
  }));
}

Result<FaultCatch> Codec<FaultCatch>::decode(const std::string& text) {
  return attest::decode(text).map([](const nlohmann::json& in) {
    FaultCatch found{*parse_verdict(in.at("verdict").get<std::string>()),
                     in.at("by").get<std::string>(),
                     {},
                     in.at("agrees_with_log").get<bool>()};
    if (in.contains("tick")) found.tick = in.at("tick").get<std::size_t>();
    return found;
  });
}

std::string Codec<HuntCatch>::encode(const Result<HuntCatch>& result) {
  return attest::encode(result.map([](const HuntCatch& found) {
    nlohmann::json out = nlohmann::json::object();
    if (found.steps_before) out["steps_before"] = *found.steps_before;
    return out;
  }));
}

Result<HuntCatch> Codec<HuntCatch>::decode(const std::string& text) {
  return attest::decode(text).map([](const nlohmann::json& in) {
    HuntCatch found;
    if (in.contains("steps_before")) found.steps_before = in.at("steps_before").get<std::size_t>();
    return found;
  });
}

Result<FaultCatch> FaultJob::run(std::size_t) {
  auto port = open_fault(fault_.id, fraction_bits_);
  if (!port) return tl::unexpected(port.error());
  InProcessHost host(*std::move(port));
  FaultCatch found;
  if (!fault_.profiles->is_of_law_of(profile_)) return found;
  // An undetectable fault without cases of its group is of a module that the cases do not have.
  const bool has_group = std::any_of(cases_.begin(), cases_.end(), [&](const SelectedCase& one) {
    return one.the_case.group == fault_.group;
  });
  if (!has_group && !fault_.is_detectable(profile_)) return found;
  std::optional<Golden> golden;
  const Case* opened = nullptr;
  for (const auto& [the_case, rate, turn] : attempts(cases_, fault_.group)) {
    if (opened != the_case) {
      auto next = goldens_.open(*the_case);
      if (!next) return tl::unexpected(next.error());
      golden.emplace(std::move(*next));
      opened = the_case;
    }
    // An undetectable fault may still round differently, which the exact level would notice.
    if (the_case->exact_only && !fault_.is_detectable(profile_)) continue;
    const Level level = level_.value_or(the_case->exact_only ? Level::exact : Level::numeric);
    if (the_case->exact_only && level != Level::exact) continue;  // its outputs are not compared
    const auto result = evaluate_case(*the_case, rate.motor_unit, *golden, host, {level});
    if (!result) return tl::unexpected(result.error());
    if (!fails_a_run(result->verdict)) continue;
    found.verdict = result->verdict;
    found.by = result->id();
    if (result->first) found.tick = result->first->tick;
    return found;
  }
  return found;
}

Result<ReferenceOnLog> judge_reference(const FlightLog& log) {
  const auto units = judge_units(log, *open_the_reference(), open_the_reference);
  if (!units) return tl::unexpected(units.error());
  ReferenceOnLog reference;
  for (const LoggedUnitResult& unit : *units) {
    const bool deviates = unit.fails() || unit.is_unlike_reference;
    if (unit.passes())
      reference.any_passes = true;
    else
      (deviates ? reference.deviations : reference.not_judged).push_back(unit.reason());
  }
  if (reference.any_passes || !reference.deviations.empty()) return reference;
  return fail_at(
      log.units.front().trace.source,
      fmt::format("shows no mistake of a port: {}", fmt::join(reference.not_judged, "; ")));
}

Result<FaultCatch> LogFaultJob::run(std::size_t) {
  const auto open = [&] { return std::make_unique<InProcessHost>(*open_fault(fault_.id)); };
  const auto judged = judge_units(log_, *open(), open_the_reference);
  if (!judged) return tl::unexpected(judged.error());
  FaultCatch found;
  const auto failed = std::ranges::find_if(*judged, &LoggedUnitResult::fails);
  if (failed != judged->end()) {
    found.verdict = failed->result.verdict;
    found.by = failed->title;
    found.tick = failed->tick;
  }
  if (!is_explanation_) return found;
  const auto agrees = agrees_with_log(log_, open);
  if (!agrees) return tl::unexpected(agrees.error());
  found.agrees_with_log = *agrees;
  return found;
}

Result<HuntCatch> HuntFaultJob::run(std::size_t) {
  if (!fault_.is_detectable(profile_)) return HuntCatch();
  const auto port = open_fault(fault_.id);
  if (!port) return tl::unexpected(port.error());
  HostOptions host;
  host.port = fmt::format("fault:{}", fault_.id);
  host.said = Declarations::asked(**port);
  host.in_process = true;  // a fault does not crash
  HuntOptions hunt;
  hunt.subjects = subjects_in(*find_profile(profile_), host.said->modules);
  hunt.least_steps = options_.steps;
  hunt.seed = options_.seed;
  hunt.level = options_.level;
  return steps_before_failure(hunt, host).map([](const std::optional<std::size_t>& steps) {
    return HuntCatch{steps};
  });
}

}  // namespace attest
