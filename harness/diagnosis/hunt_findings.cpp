#include "harness/diagnosis/hunt_findings.hpp"

#include <algorithm>
#include <memory>
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

  Result<std::vector<HuntFinding>> of(std::span<const HuntFailure> failures) {
    Jobs<ShrunkCase> jobs;
    for (const HuntFailure& failure : failures) {
      jobs.push_back(std::make_unique<ShrinkJob>(failure.target, failure.inputs, host_));
    }
    const auto shrunk = results_of(jobs, workers_, host_);
    if (!shrunk) return tl::unexpected(shrunk.error());
    for (std::size_t i = 0; i < shrunk->size(); ++i) {
      auto finding = finding_of(failures[i], (*shrunk)[i]);
      if (!finding) return tl::unexpected(finding.error());
      add(*std::move(finding));
    }
    return std::move(found_);
  }

 private:
  Result<HuntFinding> finding_of(const HuntFailure& failure, const ShrunkCase& shrunk);
  Result<void> diagnose(const HuntFailure& failure, const ShrunkCase& shrunk, HuntFinding& finding);
  std::optional<Diagnosis> diagnosis_of(const HuntTarget& target,
                                        const std::vector<std::pair<std::string, VectorResult>>&);
  void add(HuntFinding finding);

  std::span<const std::vector<HuntInputs>> passing_;
  const HuntWorkers& workers_;
  const HostOptions& host_;
  std::vector<HuntFinding> found_;
};

// "rate_law_vehicle_torque_setpoint_xyz_0", of the first deviation.
std::string name_without_fault(const VectorResult& failure) {
  if (!failure.first) return fmt::format("{}_{}", failure.name, name_of(failure.verdict));
  const Channel& channel = channels()[failure.first->channel];
  return fmt::format("{}_{}_{}", name_of(stage_of(*failure.first)), channel.topic(),
                     channel.field());
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

Result<HuntFinding> Findings::finding_of(const HuntFailure& failure, const ShrunkCase& shrunk) {
  HuntFinding finding;
  finding.trials = 1 + failure.same;
  finding.failure = shrunk.needs_others ? failure.result : shrunk.of_shrunk;
  finding.needs_others = shrunk.needs_others;
  finding.name = identifier(name_without_fault(finding.failure));
  if (shrunk.needs_others) return finding;
  finding.toml = shrunk.shrunk;
  if (failure.silent_topic.empty()) {
    if (auto done = diagnose(failure, shrunk, finding); !done) return tl::unexpected(done.error());
  } else {
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

Result<void> Findings::diagnose(const HuntFailure& failure, const ShrunkCase& shrunk,
                                HuntFinding& finding) {
  std::vector<std::pair<std::string, VectorResult>> vectors = {{shrunk.shrunk, shrunk.of_shrunk},
                                                               {shrunk.whole, shrunk.of_whole}};
  for (const HuntInputs& inputs : passing_[failure.index]) {
    auto text = case_of(inputs, failure.target.level);
    if (!text) return tl::unexpected(text.error());
    VectorResult passed;
    passed.profile = inputs.subject.profile;
    passed.rate = inputs.rate;
    vectors.emplace_back(*std::move(text), passed);
  }
  finding.diagnosis = diagnosis_of(failure.target, vectors);
  if (const faults::Fault* fault = fault_of(finding)) {
    finding.name = identifier(std::string(fault->id));
  }
  return {};
}

// `vectors`: texts of cases with their results.
std::optional<Diagnosis> Findings::diagnosis_of(
    const HuntTarget& target, const std::vector<std::pair<std::string, VectorResult>>& vectors) {
  RunResult run;
  run.level = target.level;
  run.lacks = host_.said->lacks;
  std::vector<SelectedCase> cases;
  for (const auto& [text, result] : vectors) {
    const std::string name = fmt::format("trial_{}", cases.size());
    const auto parsed =
        parse_case_text(text, fmt::format("cases/{}/{}/{}.toml", result.profile, hunt_group, name));
    if (!parsed) continue;
    cases.push_back({*parsed, {RunConfiguration{result.rate, std::nullopt}}});
    run.results.push_back(result);
    run.results.back().group = hunt_group;
    run.results.back().name = name;
  }
  DiagnosisOptions options;
  options.processes = workers_.processes;
  options.stop = workers_.stop;
  HostOptions host = host_;
  host.said->lacks.outputs = target.lacks.outputs;
  return diagnose_run(run, cases, host, options);
}

// The fault that fits best, also if others do.
const faults::Fault* best_fault(const HuntFinding& finding) {
  return fitting_faults(finding) == 0 ? nullptr : finding.diagnosis->suspects.front().fault;
}

// Findings of one cause are one finding, with the shortest case that has the name of the fault.
void Findings::add(HuntFinding finding) {
  const auto same = std::ranges::find_if(found_, [&](const HuntFinding& one) {
    const bool is_named = fault_of(one) != nullptr || fault_of(finding) != nullptr;
    return one.name == finding.name || (is_named && best_fault(one) == best_fault(finding));
  });
  if (same == found_.end()) return found_.push_back(std::move(finding));
  const auto size = [](const HuntFinding& one) {
    return std::tuple(fault_of(one) == nullptr, one.needs_others, one.trace.samples.size(),
                      one.toml.size());
  };
  finding.trials = std::max(finding.trials, same->trials);
  if (size(finding) < size(*same)) std::swap(finding, *same);
  same->trials = std::max(finding.trials, same->trials);
}

}  // namespace

std::size_t fitting_faults(const HuntFinding& finding) {
  const bool has_suspect = finding.diagnosis && !finding.diagnosis->suspects.empty();
  return has_suspect ? 1 + finding.diagnosis->suspects.front().others : 0;
}

const faults::Fault* fault_of(const HuntFinding& finding) {
  constexpr std::size_t most_named = 3;
  const std::size_t fitting = fitting_faults(finding);
  if (fitting == 0 || fitting > most_named) return nullptr;
  return finding.diagnosis->suspects.front().fault;
}

Result<std::vector<HuntFinding>> findings_of(std::span<const HuntFailure> failures,
                                             std::span<const std::vector<HuntInputs>> passing,
                                             const HuntWorkers& workers, const HostOptions& host) {
  return Findings(passing, workers, host).of(failures);
}

}  // namespace attest
