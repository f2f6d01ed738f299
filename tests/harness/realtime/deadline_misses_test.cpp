// Which deadline misses are the port's, and which the machine's: handmade ticks of a 1 kHz loop, as
// LiveUnit runs it.
#include "harness/realtime/deadline_misses.hpp"

#include <functional>

#include <gtest/gtest.h>

#include "harness/core/random.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

// The delays in the tick of release k.
struct Delays {
  Nanoseconds execution{0};   // CPU time of the step
  Nanoseconds wake_up{0};     // of the machine, before the step
  Nanoseconds preemption{0};  // of the machine, within the step
  bool waits = false;         // the step sleeps for `preemption` by itself
};

// The ticks that the loop records. A tick starts at its release or when the previous step ends. Of
// all releases that are due it uses only the last.
std::vector<LiveTick> loop(const std::function<Delays(std::int64_t)>& delays,
                           std::int64_t releases = 100, const Rate& rate = Rate::hz(1000)) {
  std::vector<LiveTick> ticks;
  Nanoseconds free{0};
  for (std::int64_t k = 0; k < releases;) {
    const Delays of = delays(k);
    LiveTick tick{k, rate.tick(k), rate.tick(k + 1), std::max(free, rate.tick(k)) + of.wake_up};
    tick.cpu = of.execution;
    tick.elapsed = of.execution + of.preemption;
    tick.waited = of.waits;
    tick.finish = free = tick.start + tick.elapsed;
    const std::int64_t due = rate.ticks_in(free + ns(1)) - 1;
    const std::int64_t next = std::max(k + 1, std::min(due, releases));
    tick.skipped = static_cast<std::uint32_t>(next - k - 1);
    ticks.push_back(tick);
    k = next;
  }
  return ticks;
}

DeadlineMisses misses(const std::function<Delays(std::int64_t)>& delays) {
  return deadline_misses(loop(delays), Rate::hz(1000), us(100));
}

Delays short_step() { return {us(20)}; }

TEST(DeadlineMisses, AreNoneWhereEveryStepIsInTime) {
  EXPECT_EQ(misses([](std::int64_t) { return short_step(); }), DeadlineMisses{});
}

TEST(DeadlineMisses, AResponseOfThePeriodIsInTimeAndOneLongerIsNot) {
  EXPECT_EQ(misses([](std::int64_t k) { return Delays{us(k == 5 ? 1000 : 20)}; }).late, 0u);
  const DeadlineMisses late = misses([](std::int64_t k) { return Delays{us(k == 5 ? 1001 : 20)}; });
  EXPECT_EQ(late.late, 1u);
  EXPECT_EQ(late.skipped, 0u);
  EXPECT_EQ(late.by_port, 1u);
}

TEST(DeadlineMisses, OfOneLongStepAreThePorts) {
  const DeadlineMisses found =
      misses([](std::int64_t k) { return Delays{us(k == 5 ? 3300 : 20)}; });
  EXPECT_EQ(found.late, 1u);
  EXPECT_EQ(found.skipped, 2u);
  EXPECT_EQ(found.by_port, 3u);
  EXPECT_EQ(found.late_starts, 1u);  // of the tick after it
  EXPECT_EQ(found.late_starts_by_port, 1u);
}

TEST(DeadlineMisses, OfALateWakeUpAreTheMachinesForStepsOfAnyLength) {
  for (const int execution : {1, 20, 103, 300, 700, 890}) {
    const DeadlineMisses found = misses([&](std::int64_t k) {
      return k == 5 ? Delays{us(execution), us(5700)} : short_step();
    });
    EXPECT_GE(found.late + found.skipped, 5u) << execution;
    EXPECT_EQ(found.by_port, 0u) << execution;
    EXPECT_EQ(found.late_starts_by_port, 0u) << execution;
  }
}

// The machine takes nearly the period, so a short step is enough for the miss.
TEST(DeadlineMisses, ThatAShortStepCompletesAreTheMachines) {
  const DeadlineMisses found = misses([](std::int64_t) { return Delays{us(20), us(985)}; });
  EXPECT_GT(found.late + found.skipped, 90u);
  EXPECT_EQ(found.by_port, 0u);
}

// Every release has this wake-up latency, so a port has to allow for it.
TEST(DeadlineMisses, ThatALongStepCompletesAreThePorts) {
  const DeadlineMisses found = misses([](std::int64_t k) {
    return Delays{us(k == 5 ? 950 : 20), us(80)};
  });
  EXPECT_EQ(found.late, 1u);
  EXPECT_EQ(found.by_port, 1u);
}

TEST(DeadlineMisses, OfAPortThatIsALittleTooSlowAtEachTickAreAllThePorts) {
  const DeadlineMisses found = misses([](std::int64_t) { return Delays{us(1020), us(5)}; });
  EXPECT_GT(found.late, 90u);
  EXPECT_GT(found.skipped, 0u);
  EXPECT_EQ(found.by_port, found.late + found.skipped);
  EXPECT_EQ(found.late_starts_by_port, found.late_starts);
  EXPECT_GT(found.late_starts, 80u);
}

TEST(DeadlineMisses, OfAPreemptionWithinTheStepAreTheMachines) {
  const DeadlineMisses found = misses([](std::int64_t k) {
    return Delays{us(20), us(0), us(k == 5 ? 3300 : 0)};
  });
  EXPECT_EQ(found.late, 1u);
  EXPECT_EQ(found.skipped, 2u);
  EXPECT_EQ(found.by_port, 0u);
  EXPECT_EQ(found.late_starts, 1u);
  EXPECT_EQ(found.late_starts_by_port, 0u);
}

TEST(DeadlineMisses, OfAStepThatSleepsByItselfAreThePorts) {
  const DeadlineMisses found = misses([](std::int64_t k) {
    return Delays{us(20), us(0), us(k == 5 ? 3300 : 0), true};
  });
  EXPECT_EQ(found.by_port, 3u);
}

// The machine's backlog also delays the ticks after it.
TEST(DeadlineMisses, OfTheMachinesBacklogAreTheMachines) {
  const DeadlineMisses found = misses([](std::int64_t k) {
    return Delays{us(20), us(k == 5 ? 990 : 0), us(k == 6 ? 980 : 0)};
  });
  EXPECT_EQ(found.late, 2u);
  EXPECT_EQ(found.by_port, 0u);
}

// A sample that the estimator did not publish: no step ran when its deadline passed.
TEST(DeadlineMisses, WithoutAStepAreTheMachines) {
  auto ticks = loop([](std::int64_t) { return Delays{us(600)}; }, 10);
  ticks[3].skipped = 4;
  const DeadlineMisses found = deadline_misses(ticks, Rate::hz(1000));
  EXPECT_EQ(found.skipped, 4u);
  EXPECT_EQ(found.by_port, 0u);
}

// After the release at 5 ms, the machine delays by 2.5 ms and the step takes 3.3 ms. The machine's
// delay alone makes the response late, and passes over the release with the deadline at 7 ms. The
// step alone passes over the release with the deadline at 8 ms, so that miss is the port's. The
// releases with deadlines at 9 and 10 ms are passed over only by the sum of both.
TEST(DeadlineMisses, ThatHappenWithoutAnyStepToo) {
  const DeadlineMisses found = misses([](std::int64_t k) {
    return k == 5 ? Delays{us(3300), us(2500)} : short_step();
  });
  EXPECT_EQ(found.late, 1u);
  EXPECT_EQ(found.skipped, 4u);
  EXPECT_EQ(found.by_port, 1u);
  const DeadlineMisses later = misses([](std::int64_t k) {
    return k == 5 ? Delays{us(1500), us(5700)} : short_step();
  });
  EXPECT_EQ(later.by_port, 0u);
}

TEST(DeadlineMisses, AStartThatIsLateWithoutTheStepBeforeIsTheMachines) {
  const DeadlineMisses found = misses([](std::int64_t k) {
    return k == 5 ? Delays{us(1300)} : Delays{us(20), us(k == 6 ? 500 : 0)};
  });
  EXPECT_EQ(found.late_starts, 1u);
  EXPECT_EQ(found.late_starts_by_port, 0u);
}

// The machine at times delays more than usual, which makes single misses its own.
TEST(DeadlineMisses, OfATooSlowPortAreNearlyAllThePortsOnARestlessMachine) {
  Random random(2);
  const DeadlineMisses found =
      deadline_misses(loop(
                          [&](std::int64_t) {
                            return Delays{us(1020), us(static_cast<int>(random.uniform(0, 40)))};
                          },
                          10'000),
                      Rate::hz(1000));
  EXPECT_GT(found.by_port, 9 * (found.late + found.skipped) / 10);
}

// Steps below nine tenths of a period, on machines that delay them at random.
TEST(DeadlineMisses, OfShortStepsAreNeverThePorts) {
  Random random(1);
  for (int run = 0; run < 300; ++run) {
    const double execution = random.uniform(0, 900), often = random.uniform();
    const auto ticks = loop(
        [&](std::int64_t) {
          const double wake_up = random.uniform() < often ? random.uniform(0, 4000) : 0;
          const double preemption = random.uniform() < often ? random.uniform(0, 2000) : 0;
          return Delays{us(static_cast<int>(execution)), us(static_cast<int>(wake_up)),
                        us(static_cast<int>(preemption))};
        },
        500);
    const DeadlineMisses found = deadline_misses(ticks, Rate::hz(1000));
    EXPECT_EQ(found.by_port, 0u) << "run " << run << ", steps of " << execution << " us";
  }
}

// A release is passed over when the next one is due: here 2 ms after the release at 5 ms.
// The machine's 0.5 ms and a step of 1.6 ms reach that only together.
TEST(DeadlineMisses, AReleaseIsPassedOverByThePortIfItsStepAloneReachesTheNext) {
  const auto late = [](Nanoseconds execution) {
    return misses([=](std::int64_t k) {
      return k == 5 ? Delays{execution, us(500)} : short_step();
    });
  };
  const DeadlineMisses together = late(us(1600));
  EXPECT_EQ(together.late, 1u);
  EXPECT_EQ(together.skipped, 1u);
  EXPECT_EQ(together.by_port, 1u);  // the deadline, not the release
  EXPECT_EQ(late(us(2100)).by_port, 2u);
}

}  // namespace
}  // namespace attest
