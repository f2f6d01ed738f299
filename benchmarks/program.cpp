// A step of a port that is a program (PROTOCOL.md) against the least that it can cost: as many
// bytes each way through two pipes, with a child that does nothing else. And the same steps in
// batches. All processes share one CPU, where the exchange is two switches of process and no
// wake-up of a CPU that sleeps. With shared memory each process has a CPU of its own.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include <benchmark/benchmark.h>
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/port/program_port.hpp"
#include "harness/trace/csv.hpp"

namespace attest::bench {
namespace {

constexpr std::size_t request_bytes = 144, answer_bytes = 92;  // of a step, with the headers

// For this thread, and for the processes that it starts meanwhile.
class OnCpu {
 public:
  // The index of a CPU among those that may be used. The last one if there are fewer.
  explicit OnCpu(int index = 0) {
    ::sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int cpu = 0, found = -1; cpu < CPU_SETSIZE && found < index; ++cpu) {
      if (!CPU_ISSET(cpu, &before_)) continue;
      CPU_ZERO(&one);
      CPU_SET(cpu, &one);
      ++found;
    }
    ::sched_setaffinity(0, sizeof one, &one);
  }
  ~OnCpu() { ::sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_;
};

bool move_all(auto move, int pipe, char* bytes, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t count = move(pipe, bytes + done, size - done);
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

[[noreturn]] void echo(int requests, int answers) {
  std::array<char, request_bytes> bytes{};
  while (move_all(::read, requests, bytes.data(), request_bytes) &&
         move_all(::write, answers, bytes.data(), answer_bytes)) {
  }
  ::_exit(EXIT_SUCCESS);
}

void bare_pipe(benchmark::State& state) {
  const OnCpu on_one_cpu;
  std::array<int, 2> in{}, out{};
  if (::pipe(in.data()) != 0 || ::pipe(out.data()) != 0) return state.SkipWithError("no pipe");
  const pid_t child = ::fork();
  if (child == 0) echo(in[0], out[1]);
  std::array<char, request_bytes> bytes{};
  for (auto _ : state) {
    move_all(::write, in[1], bytes.data(), request_bytes);
    move_all(::read, out[0], bytes.data(), answer_bytes);
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  for (const int end : {in[0], in[1], out[0], out[1]}) ::close(end);
}

struct Flight {
  Trace trace =
      *read_csv(ATTEST_SOURCE_DIR "/golden/recorded/px4-v1.5.5/fuzz_250hz.csv", TraceNeed::inputs);
  std::vector<attest_inputs> in;
  std::vector<std::uint64_t> times;
  std::unique_ptr<Port> port;
  std::unique_ptr<Unit> unit;

  explicit Flight(const std::string& command = ATTEST_BENCHMARK_PROGRAM)
      : port(*open_program(command)), unit(port->create("px4-v1.5.5")) {
    for (const Sample& sample : trace.samples) {
      in.push_back(sample.in);
      times.push_back(sample.in.timestamp);
    }
  }
};

void steps(benchmark::State& state) {
  const OnCpu on_one_cpu;
  Flight flight;
  attest_outputs out{};
  std::size_t tick = 0;
  for (auto _ : state) {
    flight.unit->step(flight.in[tick], out);
    benchmark::DoNotOptimize(out);
    tick = tick + 1 < flight.in.size() ? tick + 1 : 0;
  }
}

void trace_in_steps(benchmark::State& state) {
  const OnCpu on_one_cpu;
  Flight flight;
  attest_outputs out{};
  for (auto _ : state) {
    for (const attest_inputs& in : flight.in) flight.unit->step(in, out);
    benchmark::DoNotOptimize(out);
  }
}

void trace_in_one_batch(benchmark::State& state) {
  const OnCpu on_one_cpu;
  Flight flight;
  std::vector<Sample>& samples = flight.trace.samples;
  for (auto _ : state) {
    flight.unit->batch(samples, flight.times);
    benchmark::DoNotOptimize(samples.data());
  }
}

constexpr std::size_t exchanges = 20000;

// Sets the time of the iteration to the 99.9th percentile of single exchanges.
void percentile_of(benchmark::State& state, auto exchange) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> seconds(exchanges);
  for (auto _ : state) {
    for (std::size_t i = 0; i < exchanges; ++i) {
      const auto begin = Clock::now();
      exchange(i);
      seconds[i] = std::chrono::duration<double>(Clock::now() - begin).count();
    }
    const auto rank = seconds.begin() + exchanges / 1000 * 999;
    std::nth_element(seconds.begin(), rank, seconds.end());
    state.SetIterationTime(*rank);
  }
}

Flight flight_on_second_cpu() {
  const OnCpu second(1);
  return Flight(std::string(ATTEST_BENCHMARK_PROGRAM) + " --shared");
}

void shared_step(benchmark::State& state) {
  Flight flight = flight_on_second_cpu();
  const OnCpu first(0);
  attest_outputs out{};
  percentile_of(state, [&](std::size_t i) {
    flight.unit->step(flight.in[i % flight.in.size()], out);
    benchmark::DoNotOptimize(out);
  });
}

// Two threads that do nothing but count.
void bare_memory(benchmark::State& state) {
  alignas(64) std::atomic<std::size_t> asked = 0, answered = 0;
  std::jthread other([&](std::stop_token stop) {
    const OnCpu second(1);
    while (!stop.stop_requested()) answered = asked.load();
  });
  const OnCpu first(0);
  percentile_of(state, [&](std::size_t) {
    const std::size_t number = ++asked;
    while (answered != number) {
    }
  });
}

BENCHMARK(bare_pipe)->Name("program/bare_pipe")->UseRealTime();
BENCHMARK(steps)->Name("program/step")->UseRealTime();
BENCHMARK(trace_in_steps)->Name("program/trace_in_steps")->UseRealTime();
BENCHMARK(trace_in_one_batch)->Name("program/trace_in_batch")->UseRealTime();
BENCHMARK(shared_step)->Name("program/shared_p999")->UseManualTime()->Iterations(1);
BENCHMARK(bare_memory)->Name("program/memory_p999")->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace attest::bench
