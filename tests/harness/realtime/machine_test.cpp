// Requests to the operating system, and to other programs.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "harness/realtime/allocations.hpp"
#include "harness/realtime/cyclictest.hpp"
#include "harness/realtime/load.hpp"
#include "harness/realtime/pacer.hpp"
#include "harness/realtime/privileges.hpp"
#include "harness/realtime/usage.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

TEST(Pacer, ReturnsAtItsDeadlineOrLater) {
  for (const Nanoseconds spin : {us(0), us(500)}) {
    Pacer pacer(Pacer::now_monotonic(), Wait{spin});
    const Nanoseconds woke = pacer.wait_until(us(2000));
    EXPECT_GE(woke, us(2000));
    EXPECT_GE(pacer.now(), woke);
    EXPECT_GE(pacer.wait_until(us(1000)), woke);  // which has passed
  }
}

TEST(RealtimePrivileges, AreGotOrRefusedWithAReason) {
  std::vector<RealtimePrivilege> privileges;
  std::thread thread([&] { privileges = claim({usable_cpus().front(), 50}); });
  thread.join();
  ASSERT_EQ(privileges.size(), 3u);
  EXPECT_TRUE(privileges[0].got);
  EXPECT_EQ(privileges[1].name, "SCHED_FIFO 50");
  for (const RealtimePrivilege& right : privileges)
    EXPECT_EQ(right.got, right.why.empty()) << right.name;
}

TEST(RealtimePrivileges, ACpuThatIsNotThereIsRefused) {
  std::vector<RealtimePrivilege> privileges;
  std::thread thread([&] { privileges = claim({1023, 0}); });
  thread.join();
  EXPECT_FALSE(privileges.front().got);
  EXPECT_FALSE(privileges.front().why.empty());
}

TEST(Usage, CountsWhatAThreadDoes) {
  const Usage begin = thread_usage();
  const std::uint64_t allocations = thread_allocations();
  void* volatile memory = std::malloc(1000);
  std::free(memory);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const Usage used = thread_usage() - begin;
  EXPECT_GE(used.yields, 1);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
  EXPECT_EQ(thread_allocations(), allocations + 1);
#else
  static_cast<void>(allocations);
#endif
}

void note(int) {}

// attest has such handlers, to end a run cleanly.
TEST(Load, EndsThoughThisProcessNotesInterrupts) {
  const auto before = std::signal(SIGTERM, note);
  { const Load load(LoadKind::cpu, 2); }
  std::signal(SIGTERM, before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(Load, RunsAsLongAsItLives) {
  {
    const Load load(LoadKind::cpu, 1);
    EXPECT_NE(load.description().find("1 x cpu"), std::string::npos);
  }
  EXPECT_EQ(Load(LoadKind::io, 0).description(), "none");
  EXPECT_TRUE(parse_load_kind("cache"));
  EXPECT_EQ(parse_load_kind("disk").error().message,
            "no such kind of load: `disk`; there are cpu, cache, io");
}

TEST(Cyclictest, IsReadWithTheTextBehindIt) {
  const auto read = parse_cyclictest(
      "{\n  \"thread\": {\n    \"0\": {\"histogram\": {\"2\": 1, \"3\": 2, \"9\": 1}, \"max\": 9}\n"
      "  }\n}\n# Histogram\n000002 000001\n");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->cycles, 4);
  EXPECT_EQ(read->median, Nanoseconds(3500));
  EXPECT_EQ(read->max, us(9));
  for (const char* text : {"", "{}", "{\"thread\": 3}", "Unable to change scheduling policy!"}) {
    EXPECT_FALSE(parse_cyclictest(text)) << text;
  }
}

TEST(Cyclictest, GarbageIsRefused) {
  const auto with = [](const std::string& histogram, const std::string& max) {
    return parse_cyclictest("{\"thread\": {\"0\": {\"histogram\": " + histogram +
                            ", \"max\": " + max + "}}}");
  };
  EXPECT_TRUE(with("{\"2\": 1}", "2"));
  for (const char* histogram :
       {"{}", "{\"2\": 0}", "{\"fast\": 1}", "{\"2us\": 1}", "{\"-2\": 1}", "{\"2\": \"1\"}",
        "{\"2\": -1}", "{\"2\": 1.5}", "{\"2\": 18446744073709551615}",
        "{\"9223372036854775807\": 1}", "[1, 2]", "null"}) {
    EXPECT_FALSE(with(histogram, "2")) << histogram;
  }
  for (const char* max : {"\"2\"", "-2", "null", "9223372036854775807"}) {
    EXPECT_FALSE(with("{\"2\": 1}", max)) << max;
  }
}

// A clock that spins after its deadline wakes late by at least the spin time, every time. A machine
// is not that late 50 times in a row.
TEST(Pacer, SpinsBeforeTheDeadlineAndNotAfterIt) {
  const Nanoseconds spin = ms(3);
  Pacer pacer(Pacer::now_monotonic(), {spin});
  Nanoseconds least = Nanoseconds::max();
  for (int i = 0; i < 50 && least >= spin; ++i) {
    const Nanoseconds deadline = pacer.now() + 2 * spin;
    const Nanoseconds woke = pacer.wait_until(deadline);
    EXPECT_GE(woke, deadline);
    least = std::min(least, woke - deadline);
  }
  EXPECT_LT(least, spin);
}

}  // namespace
}  // namespace attest
