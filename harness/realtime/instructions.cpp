#include "harness/realtime/instructions.hpp"

#include <array>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace attest {
namespace {

// A file in memory, to which another program can write by a path of /proc. The kernel removes it
// when this process ends in any way.
class NamelessFile {
 public:
  NamelessFile() : descriptor_(::memfd_create("attest-callgrind", MFD_CLOEXEC)) {}
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;
  ~NamelessFile() {
    if (is_open()) ::close(descriptor_);
  }

  bool is_open() const { return descriptor_ >= 0; }
  std::string path() const { return fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_); }
  std::string text() const {
    std::string all;
    std::array<char, 1 << 16> part;
    for (;;) {
      const auto offset = static_cast<::off_t>(all.size());
      const ::ssize_t size = ::pread(descriptor_, part.data(), part.size(), offset);
      if (size <= 0) return all;
      all.append(part.data(), static_cast<std::size_t>(size));
    }
  }

 private:
  int descriptor_;  // -1: it could not be made
};

// The totals of the calls. Each part of callgrind's output has a line such as "totals: 812". A
// total of 0 is that of no call: callgrind writes it at the end of the command and of each of its
// forks.
std::vector<std::uint64_t> totals_in(const std::string& dumps) {
  constexpr std::string_view key = "totals: ";
  std::vector<std::uint64_t> totals;
  std::istringstream lines(dumps);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key)) continue;
    const std::uint64_t total = std::strtoull(line.c_str() + key.size(), nullptr, 10);
    if (total > 0) totals.push_back(total);
  }
  return totals;
}

}  // namespace

std::vector<std::uint64_t> instructions_of_calls(const std::vector<std::string>& command,
                                                 const std::string& symbol,
                                                 const ProgramLimits& limits) {
  const NamelessFile dumps;
  if (!is_installed("valgrind") || !dumps.is_open()) return {};
  // Callgrind writes a part after each call, all in one file. vgdb is off, because its pipes stay
  // in the folder for temporary files when valgrind is killed.
  std::vector<std::string> counted = {"valgrind",
                                      "--vgdb=no",
                                      "--tool=callgrind",
                                      "--collect-atstart=no",
                                      "--toggle-collect=" + symbol,
                                      "--dump-after=" + symbol,
                                      "--combine-dumps=yes",
                                      "--callgrind-out-file=" + dumps.path()};
  counted.insert(counted.end(), command.begin(), command.end());
  if (!output_of(counted, limits)) return {};
  return totals_in(dumps.text());
}

}  // namespace attest
