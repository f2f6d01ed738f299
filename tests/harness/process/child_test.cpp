#include "harness/process/child.hpp"

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace attest {
namespace {

using testing::HasSubstr;
using testing::Optional;

constexpr double patience_s = 60;  // no test waits for it

Child spawned(const std::function<void(const SendLine&)>& work) {
  auto child = Child::spawn(work);
  if (!child) {
    ADD_FAILURE() << child.error().to_string();
    std::abort();
  }
  return *std::move(child);
}

TEST(Child, SendsLines) {
  Child child = spawned([](const SendLine& send) { send("hello"); });
  EXPECT_THAT(child.wait_for_line(patience_s), Optional(std::string("hello")));
  EXPECT_EQ(child.end(), "exited with status 0");
}

TEST(Child, ALongLineArrivesWhole) {
  const std::string line(300'000, 'x');
  Child child = spawned([&](const SendLine& send) { send(line); });
  EXPECT_THAT(child.wait_for_line(patience_s), Optional(line));
}

TEST(Child, SeveralLinesArriveInOrder) {
  Child child = spawned([](const SendLine& send) {
    send("one");
    send("");
    send("three");
  });
  std::vector<std::string> lines;
  for (bool ended = false; !ended;) {
    for (std::string& line : child.read_lines(ended)) lines.push_back(std::move(line));
  }
  EXPECT_THAT(lines, testing::ElementsAre("one", "", "three"));
}

int lowest_free_descriptor() {
  const int descriptor = ::dup(STDERR_FILENO);
  ::close(descriptor);
  return descriptor;
}

TEST(Child, OneWithoutDescriptorsIsNotStarted) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const int free = lowest_free_descriptor();
  for (int spare = 0; spare < 4; ++spare) {
    const rlimit few{static_cast<rlim_t>(free + spare), before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
    const auto child = Child::spawn([](const SendLine&) {});
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
    ASSERT_FALSE(child) << spare;
    EXPECT_THAT(child.error().message, HasSubstr("`ulimit -n`"));
    EXPECT_EQ(lowest_free_descriptor(), free);
  }
}

TEST(Child, OneThatEndsWithoutAWordSaysNothing) {
  Child child = spawned([](const SendLine&) { ::_exit(3); });
  EXPECT_EQ(child.wait_for_line(patience_s), std::nullopt);
  EXPECT_EQ(child.end(), "exited with status 3");
}

// It would go on with the work of the parent: here, with the tests after this one.
TEST(Child, AnExceptionIsItsDeath) {
  Child child = spawned([](const SendLine&) { throw std::runtime_error("of a port"); });
  EXPECT_EQ(child.wait_for_line(patience_s), std::nullopt);
  EXPECT_EQ(child.end(), "was killed by signal 6 (Aborted)");
  EXPECT_THAT(child.last_words(), HasSubstr("of a port"));
}

TEST(Child, OneThatSaysNothingInTimeIsKilled) {
  Child child = spawned([](const SendLine&) {
    while (true) ::pause();
  });
  EXPECT_EQ(child.wait_for_line(0.05), std::nullopt);
  EXPECT_EQ(child.end(), "was killed by signal 9 (Killed)");
}

// As a library does that makes itself a daemon.
TEST(Child, OneThatClosesItsPipeAndGoesOnIsNotWaitedFor) {
  Child child = spawned([](const SendLine&) {
    for (int descriptor = 3; descriptor < 1024; ++descriptor) ::close(descriptor);
    while (true) ::pause();
  });
  EXPECT_EQ(child.wait_for_line(patience_s), std::nullopt);
  EXPECT_FALSE(child.was_killed());
  EXPECT_EQ(child.end(), "closed the pipe on which it answers, and went on");
}

TEST(Child, KeepsItsOutputApart) {
  testing::internal::CaptureStdout();
  Child child = spawned([](const SendLine& send) {
    std::puts("on stdout");
    std::fflush(stdout);
    std::fputs("on stderr\n", stderr);
    send("done");
  });
  EXPECT_TRUE(child.wait_for_line(patience_s));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(child.last_words(), "on stderr");
}

TEST(Child, WithoutOutputThereAreNoLastWords) {
  // What the parent has not printed yet is not the child's to print.
  std::fputs("words of the parent\n", stdout);
  Child child = spawned([](const SendLine&) { std::fflush(stdout); });
  EXPECT_EQ(child.end(), "exited with status 0");
  EXPECT_EQ(child.last_words(), "");
}

TEST(Child, LastWordsAreOneLineAtMostAndNotEndless) {
  Child child = spawned([](const SendLine&) {
    const std::string line(5000, 'y');
    std::fputs(line.c_str(), stderr);
  });
  child.end();
  EXPECT_EQ(child.last_words(), std::string(400, 'y'));
}

TEST(Child, EndlessOutputDoesNotStopIt) {
  Child child = spawned([](const SendLine& send) {
    const std::string megabyte(1 << 20, 'z');
    bool was_cut = false;
    for (int i = 0; i < 20; ++i) was_cut |= ::write(1, megabyte.data(), megabyte.size()) < 0;
    send(was_cut ? "cut" : "kept");
  });
  EXPECT_THAT(child.wait_for_line(patience_s), Optional(std::string("cut")));
}

TEST(Child, HasNoInputAndLeavesNoCore) {
  Child child = spawned([](const SendLine& send) {
    char byte = 0;
    rlimit core{1, 1};
    ::getrlimit(RLIMIT_CORE, &core);
    send(::read(0, &byte, 1) == 0 && core.rlim_cur == 0 ? "so it is" : "no");
  });
  EXPECT_THAT(child.wait_for_line(patience_s), Optional(std::string("so it is")));
}

// A report that is being written, the pipe of another worker.
TEST(Child, HasNoDescriptorOfItsParent) {
  const int opened = ::open("/dev/null", O_WRONLY);
  ASSERT_GE(opened, 0);
  Child other = spawned([](const SendLine&) { ::pause(); });
  Child child = spawned([](const SendLine& send) {
    int open = 0;
    for (int descriptor = 3; descriptor < 1024; ++descriptor) {
      open += ::fcntl(descriptor, F_GETFD) >= 0 ? 1 : 0;
    }
    send(fmt::format("{} but its pipe", open - 1));
  });
  EXPECT_THAT(child.wait_for_line(patience_s), Optional(std::string("0 but its pipe")));
  ::close(opened);
}

TEST(Child, CannotTakeAllMemory) {
  if (!memory_is_limited()) GTEST_SKIP() << "sanitizers reserve more than there is";
  Child child = spawned([](const SendLine& send) {
    const void* enough = std::malloc(std::size_t{1} << 30);
    const void* too_much = std::malloc(std::size_t{max_memory_gib} << 30);
    send(enough && !too_much ? "limited" : "not limited");
  });
  EXPECT_THAT(child.wait_for_line(patience_s), Optional(std::string("limited")));
}

TEST(Child, IsMovedWithItsProcess) {
  Child one = spawned([](const SendLine& send) { send("one"); });
  Child two = spawned([](const SendLine&) {
    while (true) ::pause();
  });
  two = std::move(one);  // the second is killed and reaped
  EXPECT_THAT(two.wait_for_line(patience_s), Optional(std::string("one")));
}

}  // namespace
}  // namespace attest
