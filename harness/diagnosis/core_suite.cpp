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

// Runs the faults on one case in some of its configurations. `vehicle_model`: of a flight.
class CandidateJob final : public Job<Candidate> {
 public:
  CandidateJob(const Case& the_case, std::vector<RunConfiguration> configurations,
               std::shared_ptr<const VehicleModel> vehicle_model, const Faults& faults,
               const Goldens& goldens)
      : case_(the_case),
        configurations_(std::move(configurations)),
        vehicle_model_(std::move(vehicle_model)),
        faults_(faults),
        goldens_(goldens) {}

  std::size_t size() const override { return configurations_.size(); }

  Result<Candidate> run(std::size_t task) override {
    const auto golden = goldens_.open(case_);
    if (!golden) return tl::unexpected(golden.error());
    Candidate candidate;
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      const auto result = judged(*faults_[i], configurations_[task], *golden);
      if (!result) return tl::unexpected(result.error());
      candidate.id = result->id();
      candidate.ticks = std::max(candidate.ticks, result->ticks);
      if (fails_a_run(result->verdict)) candidate.caught.push_back(i);
    }
    return candidate;
  }

 private:
  Result<VectorResult> judged(const faults::Fault& fault, const RunConfiguration& configuration,
                              const Golden& golden) const {
    const JudgeOptions numeric{Level::numeric};
    InProcessHost host(*open_fault(fault.id), {}, {&case_, vehicle_model_.get()});
    if (vehicle_model_)
      return evaluate_flight(case_, configuration, *vehicle_model_, golden, host, numeric);
    return evaluate_case(case_, configuration.rate.motor_unit, golden, host, numeric);
  }

  const Case& case_;
  std::vector<RunConfiguration> configurations_;
  std::shared_ptr<const VehicleModel> vehicle_model_;
  const Faults& faults_;
  const Goldens& goldens_;
};

// The case's configurations at 250 Hz, or the others.
std::vector<RunConfiguration> in_open_loop(const SelectedCase& one, bool at_250_hz) {
  std::vector<RunConfiguration> list = one.configurations;
  std::erase_if(list, [&](const RunConfiguration& configuration) {
    return (configuration.rate == Rate::hz(250)) != at_250_hz;
  });
  return list;
}

// The flight that is the quickest of those at 250 Hz and more.
RunConfiguration in_flight(const SelectedCase& one) {
  return *std::ranges::min_element(
      one.configurations, {}, [](const RunConfiguration& configuration) {
        const PlantConfiguration& flown = *configuration.plant_configuration;
        return std::tuple(configuration.rate < Rate::hz(250), configuration.rate,
                          flown.plant != PlantKind::ode, flown);
      });
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

// The cases of one core.
using Pools = std::map<std::pair<bool, Module>, std::vector<const SelectedCase*>>;

Pools pools_of(const std::vector<SelectedCase>& cases) {
  Pools pools;
  for (const SelectedCase& one : cases) {
    if (one.the_case.exact_only || is_long(one.the_case)) continue;
    pools[{one.the_case.flight.has_value(), one.the_case.module}].push_back(&one);
  }
  return pools;
}

// Chooses the vectors of one core, in two rounds.
class Choice {
 public:
  Choice(const Goldens& goldens, VehicleModels& vehicle_models, const CoreOptions& options)
      : goldens_(goldens), vehicle_models_(vehicle_models) {
    workers_.processes = options.processes;
    workers_.stop = options.stop;
  }

  Result<CoreOfModule> of(const std::vector<const SelectedCase*>& pool, Faults left) const {
    CoreOfModule core;
    core.module = pool.front()->the_case.module;
    core.flights = pool.front()->the_case.flight.has_value();
    for (const bool is_first : {true, false}) {
      auto candidates = tried(pool, is_first, left);
      if (!candidates) return tl::unexpected(candidates.error());
      std::set<std::size_t> indices;
      for (std::size_t i = 0; i < left.size(); ++i) indices.insert(i);
      cover(*std::move(candidates), indices, core);
      Faults still_left;
      for (const std::size_t i : indices) still_left.push_back(left[i]);
      left = std::move(still_left);
    }
    std::ranges::sort(core.vectors);
    return core;
  }

 private:
  // The candidates of a round with what they catch.
  Result<std::vector<Candidate>> tried(const std::vector<const SelectedCase*>& pool, bool is_first,
                                       const Faults& faults) const {
    Jobs<Candidate> jobs;
    for (const SelectedCase* one : pool) {
      std::shared_ptr<const VehicleModel> vehicle_model;
      std::vector<RunConfiguration> configurations;
      if (!one->the_case.flight) {
        configurations = in_open_loop(*one, is_first);
      } else if (is_first) {
        configurations = {in_flight(*one)};
        const auto& vehicle = configurations.front().plant_configuration->vehicle;
        auto loaded = vehicle_models_.get(vehicle);
        if (!loaded) return tl::unexpected(loaded.error());
        vehicle_model = *std::move(loaded);
      }
      jobs.push_back(std::make_unique<CandidateJob>(one->the_case, std::move(configurations),
                                                    std::move(vehicle_model), faults, goldens_));
    }
    return all_results(jobs, workers_);
  }

  const Goldens& goldens_;
  VehicleModels& vehicle_models_;
  JobOptions<Candidate> workers_;
};

}  // namespace

Result<std::vector<CoreOfModule>> core_of(const std::vector<SelectedCase>& cases,
                                          const std::string& profile, const Goldens& goldens,
                                          VehicleModels& vehicle_models,
                                          const CoreOptions& options) {
  goldens.origins_of(profile);  // read here, so that the workers have them
  const Faults all = detectable_in(profile);
  const Choice choice(goldens, vehicle_models, options);
  std::vector<CoreOfModule> cores;
  for (const auto& [_, pool] : pools_of(cases)) {
    auto core = choice.of(pool, all);
    if (!core) return tl::unexpected(core.error());
    cores.push_back(*std::move(core));
  }
  return cores;
}

}  // namespace attest
