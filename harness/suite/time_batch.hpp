// How long a port's steps take, over the corpus, and which input takes longest.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/realtime/histogram.hpp"
#include "harness/realtime/painted_stack.hpp"
#include "harness/suite/batch.hpp"

namespace attest {

struct TimeOptions {
  int repeats = 5;                  // of each vector: of each step the quickest counts
  std::optional<double> budget_us;  // steps longer than this are counted
  bool stack = true;                // measure the stack of a step, in one more run of each vector
  std::filesystem::path worst;      // where to write the vector of the slowest step; empty: nowhere
};

// Names of figures, in nanoseconds where not said. Of each vector:
namespace figure {
inline constexpr const char* steps = "steps";
inline constexpr const char* median = "median_ns";
inline constexpr const char* max = "max_ns";
inline constexpr const char* worst_tick = "worst_tick";
inline constexpr const char* stack = "stack_bytes";  // the most that a step used; of all too
// and of all together, in the last result:
inline constexpr const char* min = "min_ns";
inline constexpr const char* p90 = "p90_ns";
inline constexpr const char* p99 = "p99_ns";
inline constexpr const char* p999 = "p99_9_ns";
inline constexpr const char* over_budget = "over_budget";
inline constexpr const char* clock = "clock_ns";  // what reading the clock takes, taken off
}  // namespace figure

// Every vector of the cases, one task each, in one process one after the other, so that they do not
// disturb each other; then one task for all together, whose `reason` is the id of the slowest.
// REQUIRES: open-loop cases.
class TimeBatch final : public Batch {
 public:
  TimeBatch(std::vector<SelectedCase> cases, TimeOptions options);

  std::size_t size() const override { return vectors_.size() + 1; }
  CaseResult identity(std::size_t i) const override;
  // Repeats, and one for the stack.
  std::size_t most_parts() const override { return static_cast<std::size_t>(options_.repeats) + 1; }
  Result<void> open() override;
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  struct Vector {
    const Case* the_case;
    Setup setup;
  };
  struct Slowest {
    std::size_t vector = 0, tick = 0;
    Nanoseconds time{0};
  };

  static Trace inputs_of(const Vector& vector);
  // The quickest of each step; empty where the port went wrong, which `result` then says.
  std::vector<Nanoseconds> measure(const Vector& vector, Port& port, CaseResult& result);
  // The most stack that a step of the vector uses; empty where the port went wrong.
  std::optional<std::size_t> measure_stack(const Vector& vector, Port& port, CaseResult& result);
  Result<CaseResult> all_together(Port& port);
  Result<void> write_worst(Port& port) const;

  std::vector<SelectedCase> cases_;
  TimeOptions options_;
  std::vector<Vector> vectors_;
  Nanoseconds clock_{0};
  Histogram times_;
  std::optional<Slowest> slowest_;
  std::optional<PaintedStack> stack_;
  std::size_t most_stack_ = 0;
};

// A step that other programs can find: valgrind counts what happens in it.
inline constexpr const char* counted_step_symbol = "attest_counted_step";

}  // namespace attest
