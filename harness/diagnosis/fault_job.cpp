#include "harness/diagnosis/fault_job.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/diagnosis/hunt.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/port/fault_port.hpp"
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

}  // namespace

std::string Codec<FaultCatch>::encode(const Result<FaultCatch>& result) {
  return attest::encode(result.map([](const FaultCatch& found) {
    nlohmann::json out = {{"verdict", name_of(found.verdict)}, {"by", found.by}};
    if (found.tick) out["tick"] = *found.tick;
    return out;
  }));
}

Result<FaultCatch> Codec<FaultCatch>::decode(const std::string& text) {
  return attest::decode(text).map([](const nlohmann::json& in) {
    FaultCatch found{
        *parse_verdict(in.at("verdict").get<std::string>()), in.at("by").get<std::string>(), {}};
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

Result<FaultCatch> LogFaultJob::run(std::size_t) {
  FaultCatch found;
  for (const LoggedUnit& unit : log_.units) {
    InProcessHost host(*open_fault(fault_.id));
    const auto judged = evaluate_log(unit, log_.profile, host, {});
    if (!judged) return tl::unexpected(judged.error());
    if (!fails_a_run(judged->result.verdict)) continue;
    found.verdict = judged->result.verdict;
    found.by = info_of(unit.module).title;
    for (const TopicAgreement& topic : judged->topics) {
      if (!found.tick && topic.first_unexplained) found.tick = topic.first_unexplained->tick;
    }
    return found;
  }
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
