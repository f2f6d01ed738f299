#include "harness/diagnosis/hunt_findings.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/parse.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/diagnosis/diagnose_run.hpp"
#include "harness/golden/reference.hpp"

namespace attest {
namespace {

class Findings {
 public:
  Findings(std::span<const std::vector<HuntInputs>> passing, const HuntWorkers& workers,
           const HostOptions& host)
      : passing_(passing), workers_(workers), host_(host) {}

  Result<std::vector<HuntFinding>> of(std::span<const HuntFailure> failures);

 private:
  // A case of a diagnosis: its text, and its result.
  using Vector = std::pair<std::string, VectorResult>;
  // Failures of one module, with the same outputs.
  using Together = std::vector<std::size_t>;

  Result<HuntFinding> finding_of(const HuntFailure& failure, const ShrunkCase& shrunk) const;
  std::vector<Together> together(std::span<const HuntFailure> failures,
                                 const std::vector<ShrunkCase>& shrunk) const;
  Result<void> diagnose(std::span<const HuntFailure> failures,
                        const std::vector<ShrunkCase>& shrunk, const Together& indices,
                        std::vector<HuntFinding>& findings) const;
  std::optional<Diagnosis> diagnosis_of(const HuntTarget& target,
                                        const std::vector<Vector>& vectors) const;
  void add(HuntFinding finding);

  std::span<const std::vector<HuntInputs>> passing_;
  const HuntWorkers& workers_;
  const HostOptions& host_;
  std::vector<HuntFinding> found_;
};

// "rate_law_vehicle_torque_setpoint", of the first deviation. Without the axis: what fails about
// one axis mostly fails about the others, too.
std::string name_without_fault(const VectorResult& failure) {
  if (!failure.first) return fmt::format("{}_{}", failure.name, name_of(failure.verdict));
  const Channel& channel = channels()[failure.first->channel];
  const std::string_view field = channel.is_published_flag() ? channel.field() : "";
  return fmt::format("{}_{}_{}", name_of(stage_of(*failure.first)), channel.topic(), field);
}

std::string identifier(std::string text) {
  for (char& c : text) {
    const bool is_kept = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (!is_kept) c = '_';
  }
  while (text.ends_with('_')) text.pop_back();
  return text;
}

// The last ticks of the trace up to the first deviation, with these outputs.
Trace answer_in(const HuntFinding& finding, const Outputs& outputs) {
  Trace answer;
  answer.present = finding.trace.present;
  const std::size_t end = finding.failure.first ? finding.failure.first->tick + 1 : 0;
  for (std::size_t i = 0; i < outputs.size() && end <= finding.trace.samples.size(); ++i) {
    answer.samples.push_back(finding.trace.samples[end - outputs.size() + i]);
    answer.samples.back().copy_outputs(outputs[i].sample());
  }
  return answer;
}

Result<HuntFinding> Findings::finding_of(const HuntFailure& failure,
                                         const ShrunkCase& shrunk) const {
  HuntFinding finding;
  finding.trials = 1 + failure.same;
  finding.failure = shrunk.needs_others ? failure.result : shrunk.of_shrunk;
  finding.needs_others = shrunk.needs_others;
  finding.name = identifier(name_without_fault(finding.failure));
  if (shrunk.needs_others) return finding;
  finding.toml = shrunk.shrunk;
  if (!failure.silent_topic.empty()) {
    finding.name = "never_publishes_" + failure.silent_topic;
    finding.failure.reason = fmt::format(
        "the port never publishes {}; its other outputs are judged", failure.silent_topic);
  }
  const auto parsed = parse_case_text(
      finding.toml,
      fmt::format("cases/{}/{}/{}.toml", finding.failure.profile, hunt_group, finding.name));
  if (!parsed) return tl::unexpected(parsed.error());
  auto trace =
      reference_outputs(subject_of(*parsed), stimulate(*parsed, finding.failure.rate.motor_unit));
  if (!trace) return tl::unexpected(trace.error());
  finding.mixer = parsed->mixer;
  finding.trace = *std::move(trace);
  finding.got = answer_in(finding, shrunk.got);
  finding.got.present &= ~failure.target.lacks.outputs;
  return finding;
}

Result<std::vector<HuntFinding>> Findings::of(std::span<const HuntFailure> failures) {
  Jobs<ShrunkCase> jobs;
  for (const HuntFailure& failure : failures) {
    jobs.push_back(std::make_unique<ShrinkJob>(failure.target, failure.inputs, host_));
  }
  const auto shrunk = results_of(jobs, workers_, host_);
  if (!shrunk) return tl::unexpected(shrunk.error());
  std::vector<HuntFinding> findings;
  for (std::size_t i = 0; i < shrunk->size(); ++i) {
    auto finding = finding_of(failures[i], (*shrunk)[i]);
    if (!finding) return tl::unexpected(finding.error());
    findings.push_back(*std::move(finding));
  }
  for (const Together& indices : together(failures, *shrunk)) {
    auto done = diagnose(failures, *shrunk, indices, findings);
    if (!done) return tl::unexpected(done.error());
  }
  for (HuntFinding& finding : findings) add(std::move(finding));
  return std::move(found_);
}

// The failures that have a case and values to compare.
std::vector<Findings::Together> Findings::together(std::span<const HuntFailure> failures,
                                                   const std::vector<ShrunkCase>& shrunk) const {
  std::vector<Together> groups;
  for (std::size_t i = 0; i < failures.size(); ++i) {
    if (shrunk[i].needs_others || !failures[i].silent_topic.empty()) continue;
    const HuntTarget& target = failures[i].target;
    const auto known = std::ranges::find_if(groups, [&](const Together& group) {
      const HuntTarget& first = failures[group.front()].target;
      return first.subject.module == target.subject.module &&
             first.lacks.outputs == target.lacks.outputs;
    });
    if (known != groups.end()) {
      known->push_back(i);
    } else {
      groups.push_back({i});
    }
  }
  return groups;
}

// The id of a case of diagnosis_of().
std::string trial_id(const VectorResult& result, std::size_t number) {
  return fmt::format("{}/{}/trial_{}", result.profile, hunt_group, number);
}

// Of the suspects that explain a case, the one that explains the fewest: each mistake has a finding
// of its own, also if the others act in all of its cases.
std::optional<Suspect> suspect_of(const Diagnosis& diagnosis, const std::string& id) {
  const auto has = [&](const std::vector<std::string>& cases) {
    return std::ranges::find(cases, id) != cases.end();
  };
  std::optional<Suspect> found;
  if (has(diagnosis.unexplained_cases)) return found;
  for (const Suspect& suspect : diagnosis.suspects) {
    if (has(suspect.cases) && (!found || suspect.explained < found->explained)) found = suspect;
  }
  return found;
}

std::string pattern_of(const Diagnosis& diagnosis, const VectorResult& failure) {
  for (const Pattern& pattern : diagnosis.patterns) {
    const bool is_its = failure.first && pattern.stage == stage_of(*failure.first);
    if (is_its && pattern.says_more()) return pattern.values();
  }
  return "";
}

Result<void> Findings::diagnose(std::span<const HuntFailure> failures,
                                const std::vector<ShrunkCase>& shrunk, const Together& indices,
                                std::vector<HuntFinding>& findings) const {
  std::vector<Vector> vectors;
  for (const std::size_t i : indices) {
    vectors.emplace_back(shrunk[i].shrunk, shrunk[i].of_shrunk);
    vectors.emplace_back(shrunk[i].whole, shrunk[i].of_whole);
  }
  std::set<std::size_t> targets;
  for (const std::size_t i : indices) targets.insert(failures[i].index);
  for (const std::size_t target : targets) {
    for (const HuntInputs& inputs : passing_[target]) {
      auto text = case_of(inputs, failures[indices.front()].target.level);
      if (!text) return tl::unexpected(text.error());
      VectorResult passed;
      passed.profile = inputs.subject.profile;
      passed.rate = inputs.rate;
      vectors.emplace_back(*std::move(text), passed);
    }
  }
  const auto diagnosis = diagnosis_of(failures[indices.front()].target, vectors);
  if (!diagnosis) return {};
  for (std::size_t i = 0; i < indices.size(); ++i) {
    HuntFinding& finding = findings[indices[i]];
    finding.suspect = suspect_of(*diagnosis, trial_id(finding.failure, 2 * i));
    if (!finding.suspect) finding.pattern = pattern_of(*diagnosis, finding.failure);
    if (const faults::Fault* fault = fault_of(finding)) {
      finding.name = identifier(std::string(fault->id));
    }
  }
  return {};
}

std::optional<Diagnosis> Findings::diagnosis_of(const HuntTarget& target,
                                                const std::vector<Vector>& vectors) const {
  RunResult run;
  run.level = target.level;
  run.lacks = host_.said->lacks;
  std::vector<SelectedCase> cases;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const auto& [text, result] = vectors[i];
    const auto parsed = parse_case_text(text, fmt::format("cases/{}.toml", trial_id(result, i)));
    if (!parsed) continue;
    cases.push_back({*parsed, {RunConfiguration{result.rate, std::nullopt}}});
    run.results.push_back(result);
    run.results.back().group = hunt_group;
    run.results.back().name = fmt::format("trial_{}", i);
  }
  DiagnosisOptions options;
  options.processes = workers_.processes;
  options.stop = workers_.stop;
  HostOptions host = host_;
  host.said->lacks.outputs = target.lacks.outputs;
  return diagnose_run(run, cases, host, options);
}

// Findings of one cause are one finding, with the shortest case.
void Findings::add(HuntFinding finding) {
  const auto fault_in = [](const HuntFinding& one) {
    return one.suspect ? one.suspect->fault : nullptr;
  };
  const auto same = std::ranges::find_if(found_, [&](const HuntFinding& one) {
    const bool has_cause = one.suspect || finding.suspect;
    return has_cause ? fault_in(one) == fault_in(finding) : one.name == finding.name;
  });
  if (same == found_.end()) return found_.push_back(std::move(finding));
  const auto size = [](const HuntFinding& one) {
    return std::tuple(one.needs_others, one.trace.samples.size(), one.toml.size());
  };
  const std::size_t trials = std::max(finding.trials, same->trials);
  if (size(finding) < size(*same)) std::swap(finding, *same);
  same->trials = trials;
}

}  // namespace

std::size_t fitting_faults(const HuntFinding& finding) {
  return finding.suspect ? 1 + finding.suspect->others : 0;
}

const faults::Fault* fault_of(const HuntFinding& finding) {
  return fitting_faults(finding) == 1 ? finding.suspect->fault : nullptr;
}

Result<std::vector<HuntFinding>> findings_of(std::span<const HuntFailure> failures,
                                             std::span<const std::vector<HuntInputs>> passing,
                                             const HuntWorkers& workers, const HostOptions& host) {
  return Findings(passing, workers, host).of(failures);
}

}  // namespace attest
