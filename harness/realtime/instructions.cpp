#include "harness/realtime/instructions.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "harness/core/temporary_folder.hpp"

namespace attest {
namespace {

// The last line of callgrind's output, except empty ones, is "totals: 812".
std::optional<std::uint64_t> total_of(const std::filesystem::path& dump) {
  std::ifstream file(dump);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("totals: ")) return std::strtoull(line.c_str() + 8, nullptr, 10);
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::uint64_t> instructions_of_calls(const std::vector<std::string>& command,
                                                 const std::string& symbol,
                                                 const ProgramLimits& limits) {
  const auto folder = TemporaryFolder::make("callgrind");
  if (!is_installed("valgrind") || !folder) return {};
  const std::string dumps = (folder->path() / "dump").string();
  // A dump after each call: dump.1, dump.2, ... and the rest, which is empty, as dump.
  std::vector<std::string> counted = {"valgrind",
                                      "--tool=callgrind",
                                      "--collect-atstart=no",
                                      "--toggle-collect=" + symbol,
                                      "--dump-after=" + symbol,
                                      "--callgrind-out-file=" + dumps};
  counted.insert(counted.end(), command.begin(), command.end());
  if (!output_of(counted, limits)) return {};
  std::vector<std::uint64_t> calls;
  for (int number = 1;; ++number) {
    const auto total = total_of(fmt::format("{}.{}", dumps, number));
    if (!total) return calls;
    calls.push_back(*total);
  }
}

}  // namespace attest
