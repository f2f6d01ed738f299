// The rate of false alarms and the power of find_rhythm(), by seeded simulation.
#include "harness/realtime/rhythm.hpp"

#include <cmath>
#include <functional>
#include <set>
#include <string>

#include <boost/math/distributions/binomial.hpp>
#include <gtest/gtest.h>

#include "harness/core/random.hpp"

namespace attest {
namespace {

using Events = std::set<std::size_t>;

std::optional<Rhythm> found(const Events& events, std::size_t ticks) {
  return find_rhythm({events.begin(), events.end()}, ticks);
}

std::size_t below(Random& random, std::size_t end) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(end));
}

// At least 1, with that mean.
std::size_t geometric(Random& random, double mean) {
  const double stay = 1 - 1 / mean;
  return 1 + static_cast<std::size_t>(std::log(1 - random.uniform()) / std::log(stay));
}

Events uniform(Random& random, std::size_t ticks) {
  Events events;
  const std::size_t wanted = 3 + below(random, 1 + below(random, ticks / 4));
  while (events.size() < wanted) events.insert(below(random, ticks));
  return events;
}

// Runs of slow ticks without a gap: another program used the caches, or the clock was slow.
Events runs(Random& random, std::size_t ticks) {
  Events events;
  const double mean = random.uniform(1.5, 30);
  for (std::size_t count = 1 + below(random, 30); count > 0; --count) {
    const std::size_t begin = below(random, ticks), length = geometric(random, mean);
    for (std::size_t i = begin; i < std::min(ticks, begin + length); ++i) events.insert(i);
  }
  return events;
}

// Clusters around few points (Neyman and Scott): bursts of interrupts.
Events clusters(Random& random, std::size_t ticks) {
  Events events;
  const std::size_t spread = 2 + below(random, ticks / 10);
  for (std::size_t count = 1 + below(random, 12); count > 0; --count) {
    const std::size_t centre = below(random, ticks);
    for (std::size_t i = 1 + below(random, 20); i > 0; --i) {
      events.insert(std::min(ticks - 1, centre + below(random, spread)));
    }
  }
  return events;
}

// Ticks of a machine that is alternately busy and idle.
Events alternating(Random& random, std::size_t ticks) {
  Events events;
  const double length = random.uniform(5, 200), busy = random.uniform(0.05, 0.9);
  bool is_busy = false;
  for (std::size_t i = 0, left = 0; i < ticks; ++i, --left) {
    if (left == 0) {
      left = geometric(random, length);
      is_busy = !is_busy;
    }
    if (random.uniform() < (is_busy ? busy : 0.002)) events.insert(i);
  }
  return events;
}

// Never two slow ticks within a dead time.
Events spaced(Random& random, std::size_t ticks) {
  Events events;
  const std::size_t dead = 1 + below(random, 40);
  const double mean = random.uniform(20, 200);
  for (std::size_t i = below(random, 50); i < ticks; i += dead + geometric(random, mean)) {
    events.insert(i);
  }
  return events;
}

struct Kind {
  std::string name;
  std::function<Events(Random&, std::size_t)> events;

  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

class RhythmAtRandom : public testing::TestWithParam<Kind> {};

TEST_P(RhythmAtRandom, IsClaimedLessThanOnceInAThousandSamples) {
  constexpr int samples = 8000;
  Random random(1);
  int alarms = 0;
  for (int i = 0; i < samples; ++i) {
    const std::size_t ticks = 50 + below(random, 2000);
    alarms += found(GetParam().events(random, ticks), ticks) ? 1 : 0;
  }
  // The upper end of the interval that holds the rate with 99% confidence (Clopper and Pearson).
  using Binomial = boost::math::binomial_distribution<>;
  EXPECT_LT(Binomial::find_upper_bound_on_p(samples, alarms, 0.01), 1e-3) << alarms << " alarms";
}

INSTANTIATE_TEST_SUITE_P(Kinds, RhythmAtRandom,
                         testing::Values(Kind{"uniform", uniform}, Kind{"runs", runs},
                                         Kind{"clusters", clusters},
                                         Kind{"alternating", alternating}, Kind{"spaced", spaced}),
                         [](const auto& kind) { return kind.param.name; });

// Half a minute at 1 kHz, as the flights that stress measures.
TEST(Rhythm, IsClaimedInNoneOfALongRunsRandomSamples) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    Events events;
    while (events.size() < 60) events.insert(below(random, 30'000));
    EXPECT_FALSE(found(events, 30'000)) << "sample " << i;
  }
}

// A port is slow in every n-th step but misses some. The machine has as many slow ticks of its own,
// in runs of one to five.
TEST(Rhythm, IsFoundInTheNoiseOfAMachine) {
  Random random(3);
  int missed = 0;
  constexpr int samples = 500;
  for (int i = 0; i < samples; ++i) {
    const std::size_t every = 10 + below(random, 300), first = below(random, every);
    const std::size_t ticks = every * (10 + below(random, 60));
    Events events;
    for (std::size_t at = first; at < ticks; at += every) {
      if (random.uniform() < 0.95) events.insert(at);
    }
    for (std::size_t noise = ticks / every; noise > 0;) {
      std::size_t begin = below(random, ticks), length = 1 + below(random, 5);
      for (; length > 0 && noise > 0 && begin < ticks; --length, --noise) events.insert(begin++);
    }
    const auto rhythm = found(events, ticks);
    const bool right = rhythm && rhythm->every == every && rhythm->first % every == first;
    missed += right ? 0 : 1;
  }
  EXPECT_LT(missed, samples / 20);
}

TEST(Rhythm, OfAHundredStepsIsFoundInFiveHundred) {
  const auto rhythm = find_rhythm({99, 199, 299, 399, 499}, 500);
  ASSERT_TRUE(rhythm);
  EXPECT_EQ(rhythm->every, 100u);
  EXPECT_EQ(rhythm->first, 99u);
  EXPECT_LT(rhythm->chance, 1e-4);
}

TEST(Rhythm, IsFoundAmongManyEvents) {
  Events events;
  for (std::size_t i = 0; i < 1'000'000; i += 100) events.insert(i);
  EXPECT_EQ(found(events, 1'000'000)->every, 100u);
  EXPECT_FALSE(find_rhythm({}, 1'000'000));
}

TEST(Rhythm, NeedsFiveBlocksAndMostOfThem) {
  EXPECT_FALSE(find_rhythm({99, 199, 299, 399}, 400));
  Events half;
  for (std::size_t i = 0; i < 10'000; i += 100) half.insert(i);
  EXPECT_FALSE(found(half, 20'000));
}

}  // namespace
}  // namespace attest
