// A figure and its floor: two benchmarks that run alternately in one process, reported as a ratio.
// The speed of machines differs, and drifts within seconds. So each turn runs the figure directly
// before or after its floor, and the claim is the median of the turns' ratios.
#pragma once

#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace attest::bench {

struct Pair {
  std::string what;      // "controller step"
  std::string measured;  // names of the two benchmarks
  std::string floor;
  double bound;            // of measured time / floor time; 0: one below; infinity: no bound
  std::string claim;       // the bound in words: "at most 1.15x the hand-written law"
  double beyond_s = 0;     // bound of the difference of the two times
  double at_most_s = 0;    // bound of the measured time; the floor shows what the machine adds
  std::string speed = {};  // "flights/s": the table shows speeds of this unit instead of times

  // `measured_s` and `floor_s`: the times of each turn.
  bool is_met(const std::vector<double>& measured_s, const std::vector<double>& floor_s) const;
};

// The claims, in the order of the table. Claims that share a floor, two at most, are adjacent.
const std::vector<Pair>& pairs();

// Collects every run of every benchmark; the table shows their medians.
class PairReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;

  // Markdown, with the bounds that were missed. Sets `met` to false when one was.
  std::string table(bool& met) const;

 private:
  struct Times {
    std::string name;
    std::vector<double> seconds;  // time of one iteration, for each turn
  };
  const Times* find(const std::string& name) const;

  std::vector<Times> times_;
};

// Runs the pairs with `filter` in the name of a benchmark; "": all. False if no pair matches.
bool run_alternating(const std::string& filter, PairReporter& reporter);

}  // namespace attest::bench
