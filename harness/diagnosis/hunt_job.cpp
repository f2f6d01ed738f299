#include "harness/diagnosis/hunt_job.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/casefile/log_case.hpp"
#include "harness/casefile/parse.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/compare/input_difference.hpp"
#include "harness/core/error_json.hpp"
#include "harness/diagnosis/hunt_shrink.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::json;

json numbers_of(const HuntFeatures& features) {
  json numbers = json::array();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (features[i]) numbers.push_back(i);
  }
  return numbers;
}

json to_json(const HuntTrial& trial) {
  json out = {{"number", trial.number},          {"steps", trial.steps},
              {"deviation", trial.deviation},    {"agrees", trial.agrees},
              {"due", trial.due.to_ulong()},     {"published", trial.published.to_ulong()},
              {"meets", numbers_of(trial.meets)}};
  if (trial.failure) out["failure"] = to_json(*trial.failure);
  return out;
}

HuntTrial trial_from(const json& in) {
  HuntTrial trial;
  in.at("number").get_to(trial.number);
  in.at("steps").get_to(trial.steps);
  in.at("deviation").get_to(trial.deviation);
  in.at("agrees").get_to(trial.agrees);
  trial.due = in.at("due").get<unsigned long>();
  trial.published = in.at("published").get<unsigned long>();
  for (const json& feature : in.at("meets")) trial.meets.set(feature.get<std::size_t>());
  if (in.contains("failure")) trial.failure = vector_result_from_json(in.at("failure")).value();
  return trial;
}

}  // namespace

std::string Codec<HuntTrials>::encode(const Result<HuntTrials>& result) {
  return attest::encode(result.map([](const HuntTrials& trials) {
    json out = json::array();
    for (const HuntTrial& trial : trials) out.push_back(to_json(trial));
    return out;
  }));
}

Result<HuntTrials> Codec<HuntTrials>::decode(const std::string& text) {
  return attest::decode(text).map([](const json& in) {
    HuntTrials trials;
    for (const json& one : in) trials.push_back(trial_from(one));
    return trials;
  });
}

std::string Codec<ShrunkCase>::encode(const Result<ShrunkCase>& result) {
  return attest::encode(result.map([](const ShrunkCase& one) {
    return json{{"whole", one.whole},
                {"shrunk", one.shrunk},
                {"of_whole", to_json(one.of_whole)},
                {"of_shrunk", to_json(one.of_shrunk)},
                {"needs_others", one.needs_others},
                {"got", hex_of(one.got)}};
  }));
}

Result<ShrunkCase> Codec<ShrunkCase>::decode(const std::string& text) {
  return attest::decode(text).map([](const json& in) {
    return ShrunkCase{in.at("whole").get<std::string>(),
                      in.at("shrunk").get<std::string>(),
                      vector_result_from_json(in.at("of_whole")).value(),
                      vector_result_from_json(in.at("of_shrunk")).value(),
                      in.at("needs_others").get<bool>(),
                      outputs_from(in.at("got").get<std::string>())};
  });
}

HuntInputs HuntedTarget::trial(std::uint64_t seed, std::uint64_t number,
                               std::size_t targets) const {
  const std::size_t turn = number / targets;
  return turn < first.size() ? first[turn] : make_trial(target, seed, number, kept);
}

Result<HuntTrials> TrialJob::run(std::size_t) {
  HuntTrials trials;
  std::unique_ptr<PortHost> host;
  for (std::uint64_t number = first_; number < first_ + count_ && !options_.stop(); ++number) {
    const HuntedTarget& hunted = targets_[number % targets_.size()];
    if (auto ready = ensure_host(host, options_); !ready) return tl::unexpected(ready.error());
    const HuntInputs inputs = hunted.trial(seed_, number, targets_.size());
    auto trial = judge_trial(inputs, hunted.target, *host);
    if (!trial) return tl::unexpected(trial.error());
    const bool fails = trial->failure.has_value();
    const bool hangs = fails && trial->failure->verdict == Verdict::timeout;
    trial->number = number;
    trial->meets &= ~hunted.met;
    trials.push_back(*std::move(trial));
    if (hangs) break;  // each further trial may cost the time limit
    if (fails && ends_at_failure_) break;
    if (makes_one_instance(hunted.target)) host.reset();
  }
  return trials;
}

Result<std::string> case_of(const HuntInputs& inputs, Level level, const HuntReasons& reasons) {
  const auto trace = whole_trace_of(inputs);
  if (!trace) return tl::unexpected(trace.error());
  const TraceCase about{
      inputs.subject.profile, hunt_group,          reasons.why, inputs.rate, reasons.rates_why,
      level == Level::exact,  inputs.subject.mixer};
  std::string text = case_of_trace(*trace, about);
  const auto parsed = parse_case_text(
      text, fmt::format("cases/{}/{}/trial.toml", inputs.subject.profile, hunt_group));
  if (!parsed) return tl::unexpected(parsed.error());
  const Trace made = stimulate(*parsed, inputs.rate);
  if (const auto found = first_input_difference(made, *trace)) {
    return fail(fmt::format("a case does not make the inputs of its trial from tick {} on: {}\n{}",
                            found->tick, text_of(*found, "the case", "the trial"), text));
  }
  return text;
}

// Errors: the port cannot be started; the reference fails.
Result<Outputs> ShrinkJob::answers_to(const ShrunkTrial& shrunk) const {
  if (!shrunk.failure.first) return Outputs();
  std::unique_ptr<PortHost> host;
  if (auto ready = ensure_host(host, options_); !ready) return tl::unexpected(ready.error());
  auto trace = whole_trace_of(shrunk.inputs);
  if (!trace) return tl::unexpected(trace.error());
  trace->keep_first(shrunk.failure.first->tick + 1);
  for (Sample& sample : trace->samples) sample.clear_outputs();
  if (host->drive(shrunk.inputs.subject, *trace)) return Outputs();
  Outputs answers = outputs_of(*trace);
  const std::size_t kept = std::min(answers.size(), most_answers);
  answers.erase(answers.begin(), answers.end() - static_cast<std::ptrdiff_t>(kept));
  return answers;
}

Result<ShrunkCase> ShrinkJob::run(std::size_t) {
  ShrunkCase found;
  std::unique_ptr<PortHost> host;
  if (auto ready = ensure_host(host, options_); !ready) return tl::unexpected(ready.error());
  auto trial = judge_trial(inputs_, target_, *host);
  if (!trial) return tl::unexpected(trial.error());
  host.reset();  // one process of the port at a time
  found.needs_others = !trial->failure;
  if (found.needs_others) return found;
  found.of_whole = *trial->failure;
  auto shrunk = shrink(target_, inputs_, *trial->failure, options_);
  if (!shrunk) return tl::unexpected(shrunk.error());
  found.of_shrunk = shrunk->failure;
  auto got = answers_to(*shrunk);
  if (!got) return tl::unexpected(got.error());
  found.got = *std::move(got);
  auto whole = case_of(inputs_, target_.level), small = case_of(shrunk->inputs, target_.level);
  if (!whole) return tl::unexpected(whole.error());
  if (!small) return tl::unexpected(small.error());
  found.whole = *std::move(whole);
  found.shrunk = *std::move(small);
  return found;
}

}  // namespace attest
