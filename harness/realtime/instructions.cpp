#include "harness/realtime/instructions.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

namespace attest {
namespace {

namespace fs = std::filesystem;

// A folder that is removed with its content.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "attest-callgrind-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// The last line of callgrind's output, except empty ones, is "totals: 812".
std::optional<std::uint64_t> total_of(const fs::path& dump) {
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
  const Scratch scratch;
  if (!is_installed("valgrind") || scratch.path().empty()) return {};
  const std::string dumps = (scratch.path() / "dump").string();
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
