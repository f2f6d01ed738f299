// A step of a port that is a program (PROTOCOL.md) against the least that it can cost: as many
// bytes each way through two pipes, with a child that does nothing else. And the same steps in
// batches. All processes share one CPU, where the exchange is two switches of process and no
// wake-up of a CPU that sleeps.
#include <array>
#include <cstdlib>
#include <string>

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

class OnOneCpu {
 public:
  OnOneCpu() {
    ::sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    int cpu = 0;
    while (!CPU_ISSET(cpu, &before_)) ++cpu;
    CPU_SET(cpu, &one);
    ::sched_setaffinity(0, sizeof one, &one);
  }
  ~OnOneCpu() { ::sched_setaffinity(0, sizeof before_, &before_); }

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
  const OnOneCpu on_one_cpu;
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
  std::unique_ptr<Port> port = *open_program(ATTEST_BENCHMARK_PROGRAM);
  std::unique_ptr<Unit> unit = port->create("px4-v1.5.5");

  Flight() {
    for (const Sample& sample : trace.samples) {
      in.push_back(sample.in);
      times.push_back(sample.in.timestamp);
    }
  }
};

void steps(benchmark::State& state) {
  const OnOneCpu on_one_cpu;
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
  const OnOneCpu on_one_cpu;
  Flight flight;
  attest_outputs out{};
  for (auto _ : state) {
    for (const attest_inputs& in : flight.in) flight.unit->step(in, out);
    benchmark::DoNotOptimize(out);
  }
}

void trace_in_one_batch(benchmark::State& state) {
  const OnOneCpu on_one_cpu;
  Flight flight;
  std::vector<attest_outputs> out(flight.in.size());
  for (auto _ : state) {
    flight.unit->batch(flight.in, out, flight.times);
    benchmark::DoNotOptimize(out.data());
  }
}

BENCHMARK(bare_pipe)->Name("program/bare_pipe")->UseRealTime();
BENCHMARK(steps)->Name("program/step")->UseRealTime();
BENCHMARK(trace_in_steps)->Name("program/trace_in_steps")->UseRealTime();
BENCHMARK(trace_in_one_batch)->Name("program/trace_in_batch")->UseRealTime();

}  // namespace
}  // namespace attest::bench
