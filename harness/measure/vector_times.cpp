#include "harness/measure/vector_times.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "harness/casefile/stimulus.hpp"
#include "harness/core/file.hpp"
#include "harness/measure/clock_check.hpp"
#include "harness/trace/csv.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

class Stopwatches {
 public:
  Stopwatches(const TimeOptions& options, const HostOptions& host)
      : options_(options), host_options_(host) {}

  Result<VectorTimes> time(const Case& the_case, const RunConfiguration& configuration) {
    if (auto started = ensure_host(host_, host_options_); !started) {
      return tl::unexpected(started.error());
    }
    VectorTimes times{result_for(the_case, configuration), {}, {}, the_case.module};
    if (marks_declined(host_->declarations(), times.result)) return times;
    const Trace inputs = stimulate(the_case, configuration.rate.motor_unit);
    for (int repeat = 0; repeat < options_.runs(); ++repeat) {
      const bool with_stack = options_.stack && repeat + 1 == options_.runs();
      auto timed = timed_steps(subject_of(the_case), inputs, with_stack);
      if (!timed) return tl::unexpected(timed.error());
      if (timed->fault) {
        judge(*timed->fault, times.result);
        return VectorTimes{std::move(times.result), {}, {}, the_case.module};
      }
      if (options_.counter) {
        keep_counts(timed->costs, times);
        continue;
      }
      clock_ = timed->clock;
      keep_quickest(std::move(timed->steps), times.steps);
      times.stack_bytes = timed->stack_bytes;
    }
    times.result.ticks = times.steps.size();
    return times;
  }

  Nanoseconds clock() const { return clock_; }

 private:
  // With a fault of kind protocol if the judge measures other times than the port's process.
  Result<StepTimes> timed_steps(const ModuleUnderTest& subject, const Trace& inputs,
                                bool with_stack) {
    const TimedRequest request(*host_);
    auto timed = host_->time_steps(subject, inputs, with_stack);
    // A program does not share the process that reads the clock.
    if (!timed || timed->fault || kind_of(host_options_.port).is_program) return timed;
    request.end(*timed, with_stack, totals_);
    if (const std::string what = clock_contradiction(totals_); !what.empty()) {
      timed->fault = PortFault{PortFault::Kind::protocol, 0, what};
    }
    return timed;
  }

  // The largest count of each step is kept.
  static void keep_counts(const std::vector<StepCost>& costs, VectorTimes& times) {
    const bool is_first = times.steps.empty();
    times.steps.resize(costs.size());
    std::size_t varying = 0, stack_bytes = times.stack_bytes.value_or(0);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      const Cost cost(costs[i].cost);
      if (!is_first && cost != times.steps[i]) ++varying;
      times.steps[i] = std::max(times.steps[i], cost);
      stack_bytes = std::max<std::size_t>(stack_bytes, costs[i].stack_bytes);
    }
    times.varying = std::max(times.varying, varying);
    if (stack_bytes > 0) times.stack_bytes = stack_bytes;
  }

  static void keep_quickest(std::vector<Nanoseconds> steps, std::vector<Nanoseconds>& quickest) {
    if (quickest.empty()) {
      quickest = std::move(steps);
      return;
    }
    for (std::size_t i = 0; i < quickest.size(); ++i) {
      quickest[i] = std::min(quickest[i], steps[i]);
    }
  }

  const TimeOptions& options_;
  const HostOptions& host_options_;
  std::unique_ptr<PortHost> host_;
  Nanoseconds clock_{0};
  ClockTotals totals_;
};

// REQUIRES: with a budget, the costs have a duration.
Histogram histogram_for(const TimeOptions& options) {
  if (!options.budget_us) return Histogram();
  const double limit = *options.budget_us * 1000 / *cost_ns(options.counter);
  return Histogram(Cost(static_cast<std::int64_t>(std::min(limit, 1e18))));
}

const Case* find_case(const std::vector<SelectedCase>& cases, const std::string& id) {
  const auto found = std::find_if(cases.begin(), cases.end(),
                                  [&](const SelectedCase& one) { return one.the_case.id() == id; });
  return found == cases.end() ? nullptr : &found->the_case;
}

}  // namespace

std::optional<double> cost_ns(const std::optional<CostCounter>& counter) {
  return counter ? counter->unit_ns() : 1;
}

std::size_t VectorTimes::slowest_tick() const {
  return static_cast<std::size_t>(std::max_element(steps.begin(), steps.end()) - steps.begin());
}

Cost VectorTimes::median() const {
  std::vector<Cost> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

const VectorTimes* CorpusTimes::with_slowest_step() const {
  const VectorTimes* found = nullptr;
  for (const VectorTimes& vector : vectors) {
    if (vector.is_timed() && (!found || vector.slowest() > found->slowest())) found = &vector;
  }
  return found;
}

const VectorTimes* CorpusTimes::with_most_stack() const {
  const VectorTimes* found = nullptr;
  for (const VectorTimes& vector : vectors) {
    if (vector.stack_bytes && (!found || *vector.stack_bytes > *found->stack_bytes)) {
      found = &vector;
    }
  }
  return found;
}

std::map<Module, Histogram> CorpusTimes::by_module() const {
  std::map<Module, Histogram> modules;
  for (const VectorTimes& vector : vectors) {
    if (!vector.is_timed()) continue;
    Histogram& steps_of_module = modules[vector.module];
    for (const Cost step : vector.steps) steps_of_module.add(step);
  }
  return modules;
}

Result<CorpusTimes> time_corpus(const std::vector<SelectedCase>& cases, const TimeOptions& options,
                                const HostOptions& host,
                                const std::function<void(const VectorResult&)>& on_result) {
  Stopwatches stopwatches(options, host);
  CorpusTimes times{{}, histogram_for(options), {}};
  for (const auto& [the_case, configurations] : cases) {
    for (const RunConfiguration& configuration : configurations) {
      if (host.stop()) return times;
      auto vector = stopwatches.time(the_case, configuration);
      if (!vector) return tl::unexpected(vector.error());
      for (const Cost step : vector->steps) times.steps.add(step);
      on_result(vector->result);
      times.vectors.push_back(*std::move(vector));
      times.clock = stopwatches.clock();
    }
  }
  return times;
}

Result<void> write_slowest(const CorpusTimes& times, const std::vector<SelectedCase>& cases,
                           const HostOptions& host, AtomicFile file) {
  const VectorTimes* slowest = times.with_slowest_step();
  const Case* the_case = slowest ? find_case(cases, slowest->result.case_id()) : nullptr;
  if (!the_case) return fail("no vector was timed, so there is no slowest step to write");
  Trace trace = stimulate(*the_case, slowest->result.rate.motor_unit);
  trace.keep_first(slowest->slowest_tick() + 1);
  const auto started = start_host(host);
  if (!started) return tl::unexpected(started.error());
  ModuleUnderTest subject = subject_of(*the_case);
  subject.instances = Instances::one;  // as it was timed
  if (const auto fault = (*started)->drive(subject, trace)) return fail(fault->what);
  trace.present = channels_of(the_case->module);
  return write_csv(std::move(file), trace, all_columns(trace));
}

}  // namespace attest
