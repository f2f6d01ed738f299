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

constexpr double patience_s = 60;  // no test waits so long

Child spawned(const std::function<void(MessageSocket&)>& work,
              Child::Runs runs = Child::Runs::code_of_others) {
  auto child = Child::spawn(runs, work);
  if (!child) {
    ADD_FAILURE() << child.error().to_string();
    std::abort();
  }
  return *std::move(child);
}

// The head of its next message; empty if no message arrives in that time.
std::optional<std::string> said(Child& child, double seconds = patience_s) {
  Received received = child.receive(Patience::seconds(seconds));
  if (received.kind != Received::Kind::message) return std::nullopt;
  return std::move(received.head);
}

TEST(Child, SendsMessages) {
  Child child = spawned([](MessageSocket& parent) { parent.send("hello"); });
  EXPECT_THAT(said(child), Optional(std::string("hello")));
  EXPECT_EQ(child.end(), "exited with status 0");
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
    const auto child = Child::spawn(Child::Runs::our_code, [](MessageSocket&) {});
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
    ASSERT_FALSE(child) << spare;
    EXPECT_THAT(child.error().message, HasSubstr("`ulimit -n`"));
    EXPECT_EQ(lowest_free_descriptor(), free);
  }
}

TEST(Child, OneThatEndsWithoutAWordSaysNothing) {
  Child child = spawned([](MessageSocket&) { ::_exit(3); });
  EXPECT_EQ(said(child), std::nullopt);
  EXPECT_EQ(child.end(), "exited with status 3");
}

// Otherwise the child would continue the work of the parent: here, the later tests.
TEST(Child, AnExceptionIsItsDeath) {
  Child child = spawned([](MessageSocket&) { throw std::runtime_error("of a port"); });
  EXPECT_EQ(said(child), std::nullopt);
  EXPECT_EQ(child.end(), "was killed by signal 6 (Aborted)");
  EXPECT_THAT(child.last_words(), HasSubstr("of a port"));
}

TEST(Child, OneThatSaysNothingInTimeCanBeKilled) {
  Child child = spawned([](MessageSocket&) {
    while (true) ::pause();
  });
  EXPECT_EQ(said(child, 0.05), std::nullopt);
  child.kill();
  EXPECT_EQ(child.end(), "was killed by signal 9 (Killed)");
}

// A library that makes itself a daemon does this.
TEST(Child, OneThatClosesItsSocketAndGoesOnIsNotWaitedFor) {
  Child child = spawned([](MessageSocket&) {
    for (int descriptor = 3; descriptor < 1024; ++descriptor) ::close(descriptor);
    while (true) ::pause();
  });
  EXPECT_EQ(said(child), std::nullopt);
  EXPECT_FALSE(child.was_killed());
  EXPECT_EQ(child.end(), "closed the socket on which it answers, and went on");
}

TEST(Child, KeepsItsOutputApart) {
  testing::internal::CaptureStdout();
  Child child = spawned([](MessageSocket& parent) {
    std::puts("on stdout");
    std::fflush(stdout);
    std::fputs("on stderr\n", stderr);
    parent.send("done");
  });
  EXPECT_TRUE(said(child));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(child.last_words(), "on stderr");
}

TEST(Child, WithoutOutputThereAreNoLastWords) {
  // The child must not print the parent's buffered text.
  std::fputs("words of the parent\n", stdout);
  Child child = spawned([](MessageSocket&) { std::fflush(stdout); });
  EXPECT_EQ(child.end(), "exited with status 0");
  EXPECT_EQ(child.last_words(), "");
}

TEST(Child, LastWordsAreOneLineAtMostAndNotEndless) {
  Child child = spawned([](MessageSocket&) {
    const std::string line(5000, 'y');
    std::fputs(line.c_str(), stderr);
  });
  child.end();
  EXPECT_EQ(child.last_words(), std::string(400, 'y'));
}

TEST(Child, EndlessOutputDoesNotStopIt) {
  Child child = spawned([](MessageSocket& parent) {
    const std::string megabyte(1 << 20, 'z');
    bool was_cut = false;
    for (int i = 0; i < 20; ++i) was_cut |= ::write(1, megabyte.data(), megabyte.size()) < 0;
    parent.send(was_cut ? "cut" : "kept");
  });
  EXPECT_THAT(said(child), Optional(std::string("cut")));
}

TEST(Child, HasNoInputAndLeavesNoCore) {
  Child child = spawned([](MessageSocket& parent) {
    char byte = 0;
    rlimit core{1, 1};
    ::getrlimit(RLIMIT_CORE, &core);
    parent.send(::read(0, &byte, 1) == 0 && core.rlim_cur == 0 ? "so it is" : "no");
  });
  EXPECT_THAT(said(child), Optional(std::string("so it is")));
}

// Such as a report that is being written, or the socket of another child.
TEST(Child, HasNoDescriptorOfItsParent) {
  const int opened = ::open("/dev/null", O_WRONLY);
  ASSERT_GE(opened, 0);
  Child other = spawned([](MessageSocket&) { ::pause(); });
  Child child = spawned([](MessageSocket& parent) {
    int open = 0;
    for (int descriptor = 3; descriptor < 1024; ++descriptor) {
      open += ::fcntl(descriptor, F_GETFD) >= 0 ? 1 : 0;
    }
    parent.send(fmt::format("{} but its socket", open - 1));
  });
  EXPECT_THAT(said(child), Optional(std::string("0 but its socket")));
  ::close(opened);
}

TEST(Child, CannotTakeAllMemory) {
  if (!memory_is_limited()) GTEST_SKIP() << "sanitizers reserve more than there is";
  Child child = spawned([](MessageSocket& parent) {
    const void* enough = std::malloc(std::size_t{1} << 30);
    const void* too_much = std::malloc(std::size_t{max_memory_gib} << 30);
    parent.send(enough && !too_much ? "limited" : "not limited");
  });
  EXPECT_THAT(said(child), Optional(std::string("limited")));
}

TEST(Child, CodeOfOursHasNoLimits) {
  Child child = spawned(
      [](MessageSocket& parent) {
        rlimit files{};
        ::getrlimit(RLIMIT_FSIZE, &files);
        parent.send(files.rlim_cur == files.rlim_max ? "none" : "some");
      },
      Child::Runs::our_code);
  EXPECT_THAT(said(child), Optional(std::string("none")));
}

// What a child says that dies while a process that it started holds its socket. In a process below
// the guard: the guard of a child would end that process.
std::string seen_of_a_death() {
  Child child = spawned([](MessageSocket& parent) {
    if (::fork() == 0) {
      while (true) ::pause();
    }
    parent.send("last");
    ::_exit(7);
  });
  const std::string last = said(child).value_or("nothing");
  const bool has_ended = child.receive(Patience::seconds(patience_s)).kind == Received::Kind::ended;
  return fmt::format("{}, {}, {}", last, has_ended ? "ended" : "not ended", child.end());
}

TEST(Child, ItsDeathIsSeenAlthoughWhatItStartedLivesOn) {
  Child outer = spawned([](MessageSocket& parent) { parent.send(seen_of_a_death()); });
  EXPECT_THAT(said(outer), Optional(std::string("last, ended, exited with status 7")));
}

TEST(Child, WhatItForksDoesNotAnswerForIt) {
  Child child = spawned(
      [](MessageSocket& parent) {
        if (::fork() == 0) {
          parent.send("of the fork");
          ::_exit(EXIT_SUCCESS);
        }
        parent.send("of the child");
      },
      Child::Runs::our_code);
  EXPECT_THAT(said(child), Optional(std::string("of the child")));
  EXPECT_EQ(said(child), std::nullopt);
}

TEST(Child, IsMovedWithItsProcess) {
  Child one = spawned([](MessageSocket& parent) { parent.send("one"); });
  Child two = spawned([](MessageSocket&) {
    while (true) ::pause();
  });
  two = std::move(one);  // the second is killed and reaped
  EXPECT_THAT(said(two), Optional(std::string("one")));
}

TEST(LastWords, AreThoseOfAPanicOrTheLastLine) {
  EXPECT_EQ(last_words_in(""), "");
  EXPECT_EQ(last_words_in("one\ntwo \n\n"), "two");
  EXPECT_EQ(last_words_in("started\n"
                          "thread 'main' panicked at src/law.rs:12:9:\n"
                          "index out of bounds: the len is 3 but the index is 3\n"
                          "note: run with `RUST_BACKTRACE=1` environment variable to display\n"),
            "thread 'main' panicked at src/law.rs:12:9: index out of bounds: the len is 3 but the "
            "index is 3");
  EXPECT_EQ(last_words_in("thread 'main' panicked at 'no gain', src/law.rs:3:5\nnote: run with\n"),
            "thread 'main' panicked at 'no gain', src/law.rs:3:5");
  EXPECT_EQ(last_words_in("panic: no gain\n\ngoroutine 1 [running]:\nmain.main()\n"),
            "panic: no gain");
  EXPECT_EQ(last_words_in("thread 'main' panicked at src/law.rs:12:9:"),
            "thread 'main' panicked at src/law.rs:12:9:");
  const std::string long_line = std::string(500, 'a') + std::string(400, 'b');
  EXPECT_EQ(last_words_in(long_line), std::string(400, 'b'));
}

}  // namespace
}  // namespace attest
