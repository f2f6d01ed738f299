#include "harness/process/launcher.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

namespace attest {
namespace {

Patience longer_than_a_test() { return Patience::seconds(60); }

// Returns what `work` returns in a process below a guard, where a launcher may be started.
std::string in_worker(const std::function<std::string()>& work) {
  auto worker =
      Child::spawn(Child::Runs::our_code, [&](MessageSocket& parent) { parent.send(work()); });
  if (!worker) return worker.error().to_string();
  const Received received = worker->receive(longer_than_a_test());
  return received.kind == Received::Kind::message ? received.head : worker->end();
}

// The first message of the child of that request, or why there is none.
std::string answer_of(Launcher& launcher, const std::string& request = "") {
  auto child = launcher.launch(request);
  if (!child) return child.error().to_string();
  const Received received = child->receive(longer_than_a_test());
  return received.kind == Received::Kind::message ? received.head : child->end();
}

std::string with_launcher(const Launcher::Work& work,
                          const std::function<std::string(Launcher&)>& use,
                          double time_limit_s = 60) {
  return in_worker([&] {
    auto launcher = Launcher::start(BarrierOptions{}, work, time_limit_s);
    return launcher ? use(*launcher) : launcher.error().to_string();
  });
}

TEST(Launcher, AChildHandlesItsRequest) {
  const auto echo = [](const std::string& request, MessageSocket& owner) { owner.send(request); };
  EXPECT_EQ(with_launcher(echo,
                          [](Launcher& launcher) {
                            const std::string first = answer_of(launcher, "one");
                            return first + answer_of(launcher, "two");
                          }),
            "onetwo");
}

// A golden, for example.
TEST(Launcher, AChildDoesNotHaveWhatItsOwnerReadAfterTheStart) {
  std::string read = "nothing";
  const auto says = [&](const std::string&, MessageSocket& owner) { owner.send(read); };
  EXPECT_EQ(with_launcher(says,
                          [&](Launcher& launcher) {
                            read = "a golden";
                            return answer_of(launcher);
                          }),
            "nothing");
}

TEST(Launcher, AChildDoesNotHaveWhatAChildBeforeItWrote) {
  int count = 0;
  const auto counts = [&](const std::string&, MessageSocket& owner) {
    owner.send(fmt::format("{}", ++count));
  };
  EXPECT_EQ(with_launcher(counts,
                          [](Launcher& launcher) {
                            const std::string first = answer_of(launcher);
                            return first + answer_of(launcher);
                          }),
            "11");
}

TEST(Launcher, TheOwnerSeesHowAChildEnds) {
  const auto ends = [](const std::string& request, MessageSocket&) {
    if (request == "exits") ::_exit(3);
    ::raise(SIGTERM);
  };
  EXPECT_EQ(with_launcher(ends,
                          [](Launcher& launcher) {
                            const std::string first = answer_of(launcher, "exits");
                            return first + "; " + answer_of(launcher, "raises");
                          }),
            "exited with status 3; was killed by signal 15 (Terminated)");
}

TEST(Launcher, AChildIsTheOwnersAndLeadsAGroup) {
  const auto says = [](const std::string& owner, MessageSocket& socket) {
    const bool is_child = fmt::format("{}", ::getppid()) == owner;
    socket.send(is_child && ::getpgid(0) == ::getpid() ? "yes" : "no");
  };
  EXPECT_EQ(with_launcher(says,
                          [](Launcher& launcher) {
                            return answer_of(launcher, fmt::format("{}", ::getpid()));
                          }),
            "yes");
}

// The functions of glibc that name a thread use the number that fork() has noted.
TEST(Launcher, TheThreadOfAChildHasItsOwnNumber) {
  const auto pins_itself = [](const std::string&, MessageSocket& owner) {
    cpu_set_t one, now;
    CPU_ZERO(&one);
    CPU_SET(static_cast<unsigned>(::sched_getcpu()), &one);
    ::pthread_setaffinity_np(::pthread_self(), sizeof one, &one);
    ::sched_getaffinity(0, sizeof now, &now);
    owner.send(CPU_COUNT(&now) == 1 ? "pinned" : "not pinned");
  };
  EXPECT_EQ(with_launcher(pins_itself, [](Launcher& launcher) { return answer_of(launcher); }),
            "pinned");
}

TEST(Launcher, TheDaemonsOfAChildEndWithIt) {
  const auto stays_with_a_daemon = [](const std::string&, MessageSocket& owner) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) return;
    const pid_t daemon = ::fork();
    char byte = 0;
    if (daemon == 0) {
      ::setsid();
      static_cast<void>(!::write(pipe[1], &byte, 1));
    } else {
      static_cast<void>(!::read(pipe[0], &byte, 1));
      owner.send(fmt::format("{}", daemon));
    }
    while (true) ::pause();
  };
  EXPECT_EQ(with_launcher(stays_with_a_daemon,
                          [](Launcher& launcher) -> std::string {
                            const std::string daemon = answer_of(launcher);
                            return ::kill(std::stoi(daemon), 0) != 0 && errno == ESRCH ? "ended"
                                                                                       : daemon;
                          }),
            "ended");
}

// Sends a signal to the launcher, the only child of the calling process.
void signal_the_launcher(int signal) {
  std::ifstream children(fmt::format("/proc/{0}/task/{0}/children", ::getpid()));
  for (pid_t child = 0; children >> child;) ::kill(child, signal);
}

std::string answers_around(int signal, double time_limit_s) {
  const auto here = [](const std::string&, MessageSocket& owner) { owner.send("here"); };
  return with_launcher(
      here,
      [signal](Launcher& launcher) {
        const std::string first = answer_of(launcher);
        signal_the_launcher(signal);
        const std::string second = answer_of(launcher);
        return first + "; " + second + "; " + answer_of(launcher);
      },
      time_limit_s);
}

TEST(Launcher, OneThatWasKilledIsAnError) {
  EXPECT_EQ(answers_around(SIGKILL, 60),
            "here; a launcher process of attest was killed by signal 9 (Killed); please report "
            "this; the launcher process of attest has died");
}

TEST(Launcher, OneThatWasStoppedIsKilledAndAnError) {
  EXPECT_EQ(answers_around(SIGSTOP, 3),
            "here; a launcher process of attest did not answer within 3 s; the port may have "
            "stopped it; the launcher process of attest has died");
}

}  // namespace
}  // namespace attest
