// Detects a rhythm of events: one event at a constant interval of ticks, throughout the run.
//
// A rhythm is claimed only if a null hypothesis is rejected, because some dozens of events at
// random ticks always include several at equal distances.
//
// Null hypothesis. The ticks are cut into blocks of `every` ticks. The number of events of each
// block is given. Their places within the block are random, independently of other blocks. So
// events may cluster, and come more often in some parts of a run, as those of a busy machine do.
// This is the interval jitter test for spike trains: Amarasingham, Harrison, Hatsopoulos and Geman,
// "Conditional modeling and the jitter method of spike resampling", J. Neurophysiology 107 (2012).
//
// Statistic. K is the number of blocks that have an event at the same place `p` within the block.
// Under the null hypothesis a block with b events has one there with probability b / every, so K is
// a sum of independent Bernoulli variables. Let k be the observed value of K. If k is at least the
// mean of K plus one, P(K >= k) is at most that of a binomial distribution: the one with the same
// mean, and a trial for each block with events. Source: Hoeffding, "On the distribution of the
// number of successes in independent trials", Ann. Math. Stat. 27 (1956).
//
// Claim. A rhythm is claimed if all of these hold:
// - There are at least five blocks.
// - At least 80% of the blocks have an event at `p`.
// - This bound of P(K >= k), times the number of all pairs (every, p) that could be tried, is at
//   most 1e-4 (Bonferroni).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace attest {

struct Rhythm {
  std::size_t every = 0;
  std::size_t first = 0;  // tick of the first event of the rhythm
  double chance = 1;      // the bound above, times the number of pairs
};

// The rhythm with the shortest period; empty if none is claimed. Examines the first 131,072 ticks
// and 2,048 events only, to limit the run time. REQUIRES: `events` ascending, below `ticks`.
std::optional<Rhythm> find_rhythm(const std::vector<std::size_t>& events, std::size_t ticks);

}  // namespace attest
