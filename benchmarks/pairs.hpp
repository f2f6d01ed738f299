// A figure and its floor: two benchmarks that are run by turns, in one process, and told as a
// ratio. Machines differ, and drift within seconds: each turn runs the figure right beside its
// floor, and the median of the turns' ratios is what is claimed.
#pragma once

#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace attest::bench {

struct Pair {
  std::string what;      // "controller step"
  std::string measured;  // names of the two benchmarks
  std::string floor;
  double bound;         // of the time measured / the time of the floor; 0: of the difference
  std::string claim;    // how the bound is said: "at most 1.15x the hand-written law"
  double beyond_s = 0;  // bound of the difference
};

// The claims, in the order of the table. Those that share a floor, two at most, stand together.
const std::vector<Pair>& pairs();

// Collects every run of every benchmark; the table is made of their medians.
class PairReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;

  // Markdown. Says which bounds were missed. `met` is false when any was.
  std::string table(bool& met) const;

  // Every turn: [{"figure": ..., "measured_s": [...], "floor_s": [...], "ratio": 1.03,
  // "claim": ...}, ...]
  std::string json() const;

 private:
  struct Times {
    std::string name;
    std::vector<double> seconds;  // one a turn, of one iteration
  };
  const Times* find(const std::string& name) const;

  std::vector<Times> times_;
};

// Runs the pairs of which a benchmark's name holds `filter`; "": all. False when none does.
bool run_by_turns(const std::string& filter, PairReporter& reporter);

}  // namespace attest::bench
