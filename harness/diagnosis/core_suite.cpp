#include "harness/diagnosis/core_suite.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/port/fault_port.hpp"
#include "harness/process/job.hpp"
#include "harness/verify/evaluate.hpp"

namespace attest {

namespace {

using Faults = std::vector<const faults::Fault*>;

// A vector, and what it catches: indices of faults.
struct Candidate {
  std::string id;
  std::size_t ticks = 0;
  std::vector<std::size_t> caught;
};

}  // namespace

template <>
struct Codec<Candidate> {
  static std::string encode(const Result<Candidate>& result) {
    return attest::encode(result.map([](const Candidate& one) {
      return nlohmann::json{{"id", one.id}, {"ticks", one.ticks}, {"caught", one.caught}};
    }));
  }
  static Result<Candidate> decode(const std::string& text) {
    return attest::decode(text).map([](const nlohmann::json& in) {
      return Candidate{in.at("id"), in.at("ticks"), in.at("caught")};
    });
  }
};

namespace {

// Runs the faults on one case at some of its rates.
class CandidateJob final : public Job<Candidate> {
 public:
  CandidateJob(const Case& the_case, std::vector<LoopRate> rates, const Faults& faults,
               const Goldens& goldens)
      : case_(the_case), rates_(std::move(rates)), faults_(faults), goldens_(goldens) {}

  std::size_t size() const override { return rates_.size(); }

  Result<Candidate> run(std::size_t task) override {
    const auto golden = goldens_.open(case_);
    if (!golden) return tl::unexpected(golden.error());
    Candidate candidate;
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      InProcessHost host(*open_fault(faults_[i]->id));
      const auto result =
          evaluate_case(case_, rates_[task].motor_unit, *golden, host, {Level::numeric});
      if (!result) return tl::unexpected(result.error());
      candidate.id = result->id();
      candidate.ticks = std::max(candidate.ticks, result->ticks);
      if (fails_a_run(result->verdict)) candidate.caught.push_back(i);
    }
    return candidate;
  }

 private:
  const Case& case_;
  std::vector<LoopRate> rates_;
  const Faults& faults_;
  const Goldens& goldens_;
};

// The case's rates that are 250 Hz, or the others.
std::vector<LoopRate> rates_of(const SelectedCase& one, bool at_250_hz) {
  std::vector<LoopRate> rates;
  for (const RunConfiguration& configuration : one.configurations) {
    if ((configuration.rate == Rate::hz(250)) == at_250_hz) rates.push_back(configuration.rate);
  }
  return rates;
}

// Moves the vectors that are needed to catch what `left` still has from `candidates` to `core`.
void cover(std::vector<Candidate> candidates, std::set<std::size_t>& left, CoreOfModule& core) {
  const auto gain = [&](const Candidate& one) {
    return std::ranges::count_if(one.caught, [&](std::size_t i) { return left.contains(i); });
  };
  while (!candidates.empty()) {
    const auto best = std::ranges::min_element(candidates, {}, [&](const Candidate& one) {
      return std::tuple(-gain(one), one.ticks, one.id);
    });
    if (gain(*best) == 0) return;
    core.vectors.push_back(best->id);
    core.ticks += best->ticks;
    core.faults += static_cast<std::size_t>(gain(*best));
    for (const std::size_t i : best->caught) left.erase(i);
    candidates.erase(best);
  }
}

// The faults of the profile that any module can show.
Faults detectable_in(const std::string& profile) {
  Faults list;
  for (const faults::Fault* fault : faults::catalogue()) {
    if (fault->profiles->is_of_law_of(profile) && fault->is_detectable(profile))
      list.push_back(fault);
  }
  return list;
}

}  // namespace

Result<std::vector<CoreOfModule>> core_of(const std::vector<SelectedCase>& cases,
                                          const std::string& profile, const Goldens& goldens,
                                          const CoreOptions& options) {
  JobOptions<Candidate> workers;
  workers.processes = options.processes;
  workers.stop = options.stop;
  goldens.origins_of(profile);  // read here, so that the workers have them
  const Faults all = detectable_in(profile);
  std::map<Module, std::vector<const SelectedCase*>> by_module;
  for (const SelectedCase& one : cases) {
    if (one.the_case.exact_only || is_long(one.the_case)) continue;
    by_module[one.the_case.module].push_back(&one);
  }
  std::vector<CoreOfModule> cores;
  for (const auto& [module, of_module] : by_module) {
    CoreOfModule core{module, {}, 0, 0};
    Faults left_faults = all;
    for (const bool at_250_hz : {true, false}) {
      Jobs<Candidate> jobs;
      for (const SelectedCase* one : of_module) {
        jobs.push_back(std::make_unique<CandidateJob>(one->the_case, rates_of(*one, at_250_hz),
                                                      left_faults, goldens));
      }
      JobResults<Candidate> found = run_jobs(jobs, workers);
      if (!found.errors.empty()) return tl::unexpected(found.errors.front());
      std::set<std::size_t> left;
      for (std::size_t i = 0; i < left_faults.size(); ++i) left.insert(i);
      cover(std::move(found.results), left, core);
      Faults still_left;
      for (const std::size_t i : left) still_left.push_back(left_faults[i]);
      left_faults = std::move(still_left);
    }
    std::ranges::sort(core.vectors);
    cores.push_back(std::move(core));
  }
  return cores;
}

}  // namespace attest
