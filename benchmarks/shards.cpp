#include "benchmarks/shards.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/process/temporary_folder.hpp"

namespace attest::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t planned_samples = 1'000'000, shards = 1'000;
constexpr double bound_s = 10, plan_bound_mb = 200;

constexpr const char* sweep = R"(schema = 1
case = "px4-v1.5.5/flight/tilt_step_30"
vehicle = "iris"
plant = "mujoco"
rate = 250
design = "latin_hypercube"
samples = {}

[disperse.mass]
keys = ["vehicle.mass_kg"]
as = "factor"
distribution = "uniform"
low = 0.9
high = 1.1

[disperse.tilt]
keys = ["case.flight.start.tilt_deg"]
distribution = "uniform"
low = -5
high = 5

[require.tilts]
max = 1.2
probability = 0.9
)";

struct Cost {
  double seconds = 0, peak_mb = 0;
};

// Of a whole process of attest. Empty: it failed.
std::optional<Cost> cost_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ATTEST_BENCHMARK_ATTEST);
  std::vector<char*> words;
  for (std::string& one : arguments) words.push_back(one.data());
  words.push_back(nullptr);
  const auto begin = std::chrono::steady_clock::now();
  const pid_t process = ::fork();
  if (process == 0) {
    ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
    ::execv(words[0], words.data());
    ::_exit(127);
  }
  int status = 0;
  struct rusage usage {};
  if (::wait4(process, &status, 0, &usage) != process || !WIFEXITED(status)) return std::nullopt;
  if (WEXITSTATUS(status) > 1) return std::nullopt;  // 1: a requirement is not shown
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  return Cost{took.count(), static_cast<double>(usage.ru_maxrss) / 1024};
}

// The names of the columns, from a sweep of one sample.
std::vector<std::string> columns_of(const fs::path& folder) {
  std::ifstream table(folder / "samples.csv");
  std::string line, name;
  std::getline(table, line);
  std::istringstream names(line);
  std::vector<std::string> columns;
  while (std::getline(names, name, ',')) columns.push_back(name);
  return columns;
}

// Rows that were not flown: a million flights take hours.
void make_up_rows(const fs::path& folder, const std::vector<std::string>& columns) {
  std::mt19937_64 random(1);
  for (std::uint64_t shard = 1; shard <= shards; ++shard) {
    std::string text;
    for (const std::string& column : columns) text += (text.empty() ? "" : ",") + column;
    const std::uint64_t end = planned_samples * shard / shards;
    for (std::uint64_t sample = planned_samples * (shard - 1) / shards; sample < end; ++sample) {
      text += fmt::format("\n{}", sample);
      for (std::size_t i = 1; i < columns.size(); ++i) {
        const bool is_outcome = columns[i].ends_with(".outcome");
        text += is_outcome ? ",done" : fmt::format(",{}", static_cast<double>(random()) * 0x1p-64);
      }
    }
    std::ofstream(folder / fmt::to_string(shard) / "samples.csv") << text << "\n";
  }
}

std::string row_of(const char* what, const std::optional<Cost>& cost, double most_mb, bool& met) {
  if (!cost) {
    met = false;
    return fmt::format("| {} | FAILED | | | MISSED |\n", what);
  }
  const bool holds = cost->seconds <= bound_s && (most_mb == 0 || cost->peak_mb <= most_mb);
  met = met && holds;
  return fmt::format(
      "| {} | {:.2f} s | {:.0f} MB | at most {:g} s{} | {} |\n", what, cost->seconds, cost->peak_mb,
      bound_s, most_mb == 0 ? "" : fmt::format(" and {:g} MB", most_mb), holds ? "met" : "MISSED");
}

}  // namespace

std::string shards_table(bool& met) {
  const auto scratch = TemporaryFolder::make("bench");
  if (!scratch) {
    met = false;
    return scratch.error().to_string() + "\n";
  }
  const fs::path top = scratch->path(), plan = top / "plan";
  std::ofstream(top / "sweep.toml") << fmt::format(fmt::runtime(sweep), planned_samples);
  const std::vector<std::string> command = {"-q", "sweep", top / "sweep.toml"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), command.begin(), command.end());
    return more;
  };
  const auto planned = cost_of(
      with({"--plan", "slurm", "--shards", fmt::to_string(shards), "--out", plan.string()}));
  cost_of(with({"--samples", "1", "--out", top / "one"}));
  make_up_rows(plan / "shards", columns_of(top / "one"));
  const auto merged = cost_of(with({"--merge", plan / "shards", "--out", top / "merged"}));
  return fmt::format(
             "| {} samples in {} shards | time | peak memory | claimed | |\n"
             "|---|---|---|---|---|\n",
             planned_samples, shards) +
         row_of("planned", planned, plan_bound_mb, met) +
         row_of("merged, with the report; the rows are made up", merged, 0, met);
}

}  // namespace attest::bench
