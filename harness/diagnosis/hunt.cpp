#include "harness/diagnosis/hunt.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "harness/diagnosis/hunt_job.hpp"
#include "harness/diagnosis/hunt_shrink.hpp"
#include "harness/diagnosis/hunt_silence.hpp"
#include "harness/port/features.hpp"
#include "harness/port/port.hpp"

namespace attest {
namespace {

// A round: parts that have a process of the port each, with so many trials. A program is slow.
constexpr std::size_t parts_of_round = 8;
constexpr std::size_t trials_of_part = 128, trials_of_part_of_program = 16;

// Kept inputs of all targets together: they are in memory.
constexpr std::size_t most_kept = 1500;
// Trials that are shrunk, of those that fail first in the same output.
constexpr std::size_t most_same = 3;
// Trials that pass, to tell faults apart.
constexpr std::size_t most_passing_trials = 8;
// Without an answer in time, after which the hunt ends.
constexpr std::size_t most_timeouts = 5;

// What the port declares that it lacks; a group of cases that it does not support, too, if it is
// named after a feature.
Lacks lacks_of(const Declarations& port) {
  Lacks lacks = port.lacks;
  for (const std::string& group : port.unsupported_groups) {
    if (const auto feature = feature_named(group)) lacks.features |= only(*feature);
  }
  return lacks;
}

HuntInputs to_vary(HuntInputs inputs) {
  constexpr std::uint32_t most_quiet = 1000;  // its variations would take too long
  for (HuntTick& tick : inputs.ticks) tick.quiet = std::min(tick.quiet, most_quiet);
  return inputs;
}

bool has_failure(const HuntTrials& trials) {
  return std::ranges::any_of(trials, [](const HuntTrial& one) { return one.failure.has_value(); });
}

class Hunt {
 public:
  Hunt(const HuntOptions& options, const HostOptions& host)
      : options_(options),
        host_(host),
        count_(kind_of(host.port).is_program ? trials_of_part_of_program : trials_of_part),
        silences_(options.seed) {
    const Declarations& port = *host.said;
    for (const ModuleUnderTest& subject : options.subjects) {
      targets_.push_back(
          {{subject, options.level, port.fixed_step, lacks_of(port)}, {}, {}, {}, 0});
      begin_with_cases(targets_.back());
    }
    passing_.resize(targets_.size());
  }

  Result<HuntRun> run() {
    do {
      if (auto done = round(); !done) return tl::unexpected(done.error());
      options_.on_round(run_.progress);
      if (options_.fail_fast && run_.ended_early.empty() && has_finding()) {
        run_.ended_early = "at the first finding";
      }
    } while (goes_on());
    options_.on_end();
    note_silences();
    auto found = findings_of(failures_, passing_, options_.workers, host_);
    if (!found) return tl::unexpected(found.error());
    run_.findings = *std::move(found);
    return std::move(run_);
  }

  Result<std::optional<std::size_t>> steps_before_failure() {
    do {
      const std::size_t before = run_.progress.steps;
      const auto results = trials_of_round(true);
      if (!results) return tl::unexpected(results.error());
      if (std::ranges::any_of(*results, has_failure)) return before;
      if (auto taken = take_round(*results); !taken) return tl::unexpected(taken.error());
      options_.on_round(run_.progress);
    } while (goes_on());
    return std::nullopt;
  }

 private:
  bool goes_on() const {
    const bool is_done = run_.progress.steps >= options_.least_steps && has_tried_cases();
    return !is_done && !options_.is_over() && run_.ended_early.empty();
  }
  bool has_finding() const { return !failures_.empty() || !silences_.found().empty(); }
  void begin_with_cases(HuntedTarget& hunted) const;
  bool has_tried_cases() const;
  Result<void> round();
  Result<std::vector<HuntTrials>> trials_of_round(bool ends_at_failure = false) const;
  Result<void> take_round(const std::vector<HuntTrials>& round);
  Result<void> check_steps(const std::vector<HuntTrials>& trials) const;
  Result<void> take(const HuntTrial& trial, std::vector<std::vector<HuntInputs>>& kept);
  Result<void> tell_news(const HuntedTarget& hunted, const HuntInputs& inputs,
                         const HuntFeatures& news);
  void note_failure(std::size_t target, HuntInputs inputs, const VectorResult& result);
  void note_silences();

  const HuntOptions& options_;
  const HostOptions& host_;
  const std::size_t count_;  // trials of a part
  std::vector<HuntedTarget> targets_;
  std::uint64_t next_ = 0;    // trial
  std::size_t timeouts_ = 0;  // trials that ended by one
  HuntSilences silences_;
  std::vector<HuntFailure> failures_;
  std::vector<std::vector<HuntInputs>> passing_;  // of each target
  HuntRun run_;
};

void Hunt::begin_with_cases(HuntedTarget& hunted) const {
  for (const HuntInputs& inputs : options_.first) {
    const bool is_own = contains(std::span(&hunted.target.subject, 1), inputs.subject.profile,
                                 inputs.subject.module);
    if (!is_own || inputs.ticks.empty()) continue;
    hunted.first.push_back(fit_trial(hunted.target, inputs));
    hunted.kept.push_back(to_vary(hunted.first.back()));
  }
}

bool Hunt::has_tried_cases() const {
  return std::ranges::all_of(targets_, [&](const HuntedTarget& hunted) {
    return hunted.first.size() * targets_.size() <= next_;
  });
}

// `ends_at_failure`: the trials after the first failing one may be left out.
Result<std::vector<HuntTrials>> Hunt::trials_of_round(bool ends_at_failure) const {
  Jobs<HuntTrials> jobs;
  for (std::size_t part = 0; part < parts_of_round; ++part) {
    jobs.push_back(std::make_unique<TrialJob>(targets_, options_.seed, next_ + part * count_,
                                              count_, host_, ends_at_failure));
  }
  return results_of(jobs, options_.workers, host_, ends_at_failure ? has_failure : nullptr);
}

Result<void> Hunt::round() {
  auto results = trials_of_round();
  while (results && silences_.take(*results, targets_)) results = trials_of_round();
  if (options_.workers.stop()) {
    run_.ended_early = "interrupted";
    return {};
  }
  if (!results) return tl::unexpected(results.error());
  return take_round(*results);
}

Result<void> Hunt::take_round(const std::vector<HuntTrials>& round) {
  if (auto stepped = check_steps(round); !stepped) return stepped;
  next_ += parts_of_round * count_;
  std::vector<std::vector<HuntInputs>> kept(targets_.size());
  for (const HuntTrials& trials : round) {
    for (const HuntTrial& trial : trials) {
      if (auto taken = take(trial, kept); !taken) return taken;
    }
  }
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    std::ranges::move(kept[i], std::back_inserter(targets_[i].kept));
  }
  if (timeouts_ >= most_timeouts) {
    run_.ended_early = fmt::format("the port did not answer in time in {} trials", timeouts_);
  }
  return {};
}

// Errors: a target was never tried, because the port lacks what each of its trials uses.
Result<void> Hunt::check_steps(const std::vector<HuntTrials>& trials) const {
  std::vector<std::size_t> made(targets_.size()), steps(targets_.size());
  for (const HuntTrials& part : trials) {
    for (const HuntTrial& trial : part) {
      ++made[trial.number % targets_.size()];
      steps[trial.number % targets_.size()] += trial.steps;
    }
  }
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const ModuleUnderTest& subject = targets_[i].target.subject;
    if (made[i] == 0 || steps[i] > 0) continue;
    return fail(fmt::format("{} of {} cannot be hunted: each trial uses what the port lacks",
                            name_of(subject.module), subject.profile));
  }
  return {};
}

// `kept`: of each target, the inputs of this round that later trials vary.
Result<void> Hunt::take(const HuntTrial& trial, std::vector<std::vector<HuntInputs>>& kept) {
  ++run_.progress.trials;
  run_.progress.steps += trial.steps;
  run_.progress.met |= trial.meets;
  const std::size_t index = trial.number % targets_.size();
  HuntedTarget& hunted = targets_[index];
  const auto inputs = [&] { return hunted.trial(options_.seed, trial.number, targets_.size()); };
  if (trial.failure) {
    ++run_.progress.failures;
    timeouts_ += trial.failure->verdict == Verdict::timeout ? 1 : 0;
    note_failure(index, inputs(), *trial.failure);
    return {};
  }
  auto& passing = passing_[index];
  if (passing.size() < most_passing_trials && trial.agrees) passing.push_back(inputs());
  constexpr double larger = 1.3;
  const HuntFeatures news = trial.meets & ~hunted.met;
  const bool is_larger = trial.deviation > hunted.deviation * larger && trial.deviation > 1e-3;
  hunted.met |= trial.meets;
  hunted.deviation = std::max(hunted.deviation, trial.deviation);
  run_.progress.deviation = std::max(run_.progress.deviation, trial.deviation);
  const bool is_of_case = trial.number / targets_.size() < hunted.first.size();  // already kept
  const std::size_t of_trials = hunted.kept.size() - hunted.first.size() + kept[index].size();
  const bool has_room =
      is_of_case || of_trials < std::max<std::size_t>(24, most_kept / targets_.size());
  if (!(news.any() || is_larger) || !has_room) return {};
  if (!is_of_case) kept[index].push_back(to_vary(inputs()));
  if (news.none() || !options_.on_new) return {};
  // The inputs of a case are whole, so that they are the same case in each hunt.
  return tell_news(hunted, is_of_case ? inputs() : begin_that_meets(news, inputs()), news);
}

Result<void> Hunt::tell_news(const HuntedTarget& hunted, const HuntInputs& inputs,
                             const HuntFeatures& news) {
  const auto toml = case_of(inputs, options_.level,
                            {fmt::format("Kept by attest hunt: {}.", text_of(news)),
                             "The inputs were made for this rate."});
  if (!toml) return tl::unexpected(toml.error());
  return options_.on_new(hunted.target.subject.profile, *toml);
}

void Hunt::note_failure(std::size_t target, HuntInputs inputs, const VectorResult& result) {
  std::size_t same = 0;
  for (HuntFailure& failure : failures_) {
    const Module module = failure.target.subject.module;
    const bool is_same_module = module == targets_[target].target.subject.module;
    if (!is_same_module || !fail_the_same_way(failure.result, result)) continue;
    ++failure.same;
    if (++same == most_same) return;
  }
  failures_.push_back({target, targets_[target].target, std::move(inputs), result});
}

void Hunt::note_silences() {
  for (const HuntSilence& silence : silences_.found()) {
    const HuntedTarget& hunted = targets_[silence.target];
    failures_.insert(failures_.begin(),
                     {silence.target, only_topic(silence, hunted), silence.inputs, silence.failure,
                      0, std::string(topic_of(silence, hunted))});
  }
}

}  // namespace

Result<HuntRun> hunt(const HuntOptions& options, const HostOptions& host) {
  return Hunt(options, host).run();
}

Result<std::optional<std::size_t>> steps_before_failure(const HuntOptions& options,
                                                        const HostOptions& host) {
  return Hunt(options, host).steps_before_failure();
}

std::vector<ModuleUnderTest> subjects_in(const ProfileInfo& profile, const ModuleSet& of_port) {
  std::vector<ModuleUnderTest> subjects;
  for (const ModuleInfo& info : modules()) {
    const bool has_it = contains(profile.modules, info.module) && contains(of_port, info.module);
    if (has_it) subjects.push_back({std::string(profile.name), info.module});
  }
  return subjects;
}

}  // namespace attest
