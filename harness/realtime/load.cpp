#include "harness/realtime/load.hpp"

#include <array>
#include <cstdio>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "harness/process/program.hpp"

namespace attest {
namespace {

constexpr std::array<std::string_view, 3> names = {"cpu", "cache", "io"};

[[noreturn]] void use_cpu() {
  volatile double value = 1;
  while (true) value = value * 1.0000001 + 1e-9;
}

// Walks through more memory than most caches hold, a line at a time.
[[noreturn]] void use_cache() {
  constexpr std::size_t bytes = 64u << 20, line = 64;
  std::vector<unsigned char> memory(bytes);
  volatile unsigned char* const cells = memory.data();
  while (true) {
    for (std::size_t at = 0; at < bytes; at += line) {
      cells[at] = static_cast<unsigned char>(cells[at] + 1);
    }
  }
}

[[noreturn]] void use_disk() {
  std::FILE* const file = std::tmpfile();
  const std::vector<char> block(1u << 20, 'x');
  while (file != nullptr) {
    std::rewind(file);
    std::fwrite(block.data(), 1, block.size(), file);
    std::fflush(file);
    ::fdatasync(fileno(file));
  }
  use_cpu();
}

[[noreturn]] void use(LoadKind kind) {
  switch (kind) {
    case LoadKind::cache:
      use_cache();
    case LoadKind::io:
      use_disk();
    case LoadKind::cpu:
      break;
  }
  use_cpu();
}

// Empty when stress-ng ends at once.
std::optional<Process> stress_ng(LoadKind kind, int workers, const std::string& folder) {
  constexpr double refuses_within_s = 0.2;
  // Without --temp-path, stress-ng writes temporary files to the current folder.
  auto process = start_program({"stress-ng", fmt::format("--{}", name_of(kind)),
                                fmt::to_string(workers), "--temp-path", folder});
  if (!process || process->ends_within(refuses_within_s)) return std::nullopt;
  return *std::move(process);
}

}  // namespace

std::string_view name_of(LoadKind kind) { return names[static_cast<std::size_t>(kind)]; }

Result<LoadKind> parse_load_kind(std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<LoadKind>(i);
  }
  return fail(
      fmt::format("no such kind of load: `{}`; there are {}", name, fmt::join(names, ", ")));
}

Load::Load(LoadKind kind, int workers) {
  if (workers == 0) return;
  if (is_installed("stress-ng")) {
    if (auto folder = TemporaryFolder::make("load")) folder_.emplace(*std::move(folder));
  }
  if (auto process = folder_ ? stress_ng(kind, workers, folder_->path()) : std::nullopt) {
    processes_.push_back(*std::move(process));
    description_ = fmt::format("{} x {} (stress-ng)", workers, name_of(kind));
    return;
  }
  for (int i = 0; i < workers; ++i) {
    if (auto process = Process::start([&] { use(kind); }))
      processes_.push_back(*std::move(process));
  }
  description_ = fmt::format("{} x {} (own processes)", processes_.size(), name_of(kind));
}

Load::~Load() {
  constexpr double grace_s = 2;  // stress-ng removes its files
  for (Process& process : processes_) process.terminate();
  for (Process& process : processes_) process.end(grace_s);
}

}  // namespace attest
