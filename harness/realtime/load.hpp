// Load on the machine during a stress run.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/process/process.hpp"
#include "harness/process/temporary_folder.hpp"

namespace attest {

enum class LoadKind { cpu, cache, io };
std::string_view name_of(LoadKind kind);
Result<LoadKind> parse_load_kind(std::string_view name);

// Runs `workers` from construction to destruction. They are those of stress-ng if it is installed
// and does not end at once, or else processes of attest. They may run on all CPUs, have ordinary
// priority, and die with this process. Destruction takes a few seconds at most.
class Load {
 public:
  Load(LoadKind kind, int workers);
  ~Load();
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

  // "4 x cpu (stress-ng)", "none".
  const std::string& description() const { return description_; }

 private:
  std::optional<TemporaryFolder> folder_;  // for the files of stress-ng
  std::vector<Process> processes_;
  std::string description_ = "none";
};

}  // namespace attest
