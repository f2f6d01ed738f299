#include "harness/verify/recorded_check.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "harness/compare/compare.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/golden/reference.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> traces_below(const fs::path& folder) {
  auto files = suite_files_below(folder).value_or(std::vector<fs::path>());
  std::erase_if(files, [](const fs::path& file) { return file.extension() != ".csv"; });
  return files;
}

// An edited recording is not evidence of the firmware's behaviour.
Result<void> check_bytes(const fs::path& file, const Provenance& provenance) {
  const auto recorded = provenance.sha256.find(file.filename().string());
  if (recorded == provenance.sha256.end()) {
    return fail_at(file.string(), "is not listed under [sha256] in provenance.toml");
  }
  const auto text = read_suite_file(file);
  if (!text) return tl::unexpected(text.error());
  if (sha256(*text) == recorded->second) return {};
  return fail_at(file.string(),
                 "is not what was recorded (its SHA-256 is another than in "
                 "provenance.toml); restore it from version control");
}

// Describes the difference; empty when the trace conforms.
Result<std::string> trace_difference(const fs::path& file) {
  const auto recorded = read_recorded(file);
  if (!recorded) return tl::unexpected(recorded.error());
  const auto outputs = reference_outputs(recorded->subject, recorded->trace);
  if (!outputs) return outputs.error().to_string();
  const auto comparison = compare(*outputs, recorded->trace, Tolerances(Level::exact));
  if (!comparison.first) return comparison.mismatch;
  return fmt::format("{} at tick {}", channels()[comparison.first->channel].name,
                     comparison.first->tick);
}

Result<std::string> difference(const fs::path& file) {
  const auto provenance = read_provenance(file.parent_path() / provenance_name);
  if (!provenance) return tl::unexpected(provenance.error());
  if (auto intact = check_bytes(file, *provenance); !intact) {
    return tl::unexpected(intact.error());
  }
  return trace_difference(file);
}

}  // namespace

Result<RecordedCheck> check_recorded(const fs::path& folder) {
  RecordedCheck check;
  for (const fs::path& file : traces_below(folder)) {
    const auto found = difference(file);
    if (!found) return tl::unexpected(found.error());
    ++check.traces;
    check.conforming += found->empty() ? 1 : 0;
    if (!found->empty() && check.first_difference.empty()) {
      check.first_difference = fmt::format("{}: {}", file.string(), *found);
    }
  }
  if (check.traces == 0) return fail_at(folder.string(), "no recorded traces in here");
  return check;
}

Result<std::set<std::string>> covered_groups(const fs::path& folder) {
  std::set<fs::path> folders;
  for (const fs::path& file : traces_below(folder)) folders.insert(file.parent_path());
  std::set<std::string> groups;
  for (const fs::path& one : folders) {
    const auto provenance = read_provenance(one / provenance_name);
    if (!provenance) return tl::unexpected(provenance.error());
    for (const std::string& group : provenance->covers) {
      groups.insert(provenance->profile + "/" + group);
    }
  }
  return groups;
}

}  // namespace attest
