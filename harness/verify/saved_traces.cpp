#include "harness/verify/saved_traces.hpp"

#include <map>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "harness/trace/csv.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

Result<void> write_traces(const std::filesystem::path& folder, const std::string& label,
                          const Subject& subject, const Trace& got, const Trace& want) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return fail_at(folder.string(), "cannot be made: " + failed.message());
  std::map<std::string, std::string> mixers;
  if (subject.module == Module::mixer) {
    mixers = {{label + ".got", subject.mixer}, {label + ".want", subject.mixer}};
  }
  if (auto added = add_origin(folder, subject.profile, mixers); !added) return added;
  CsvColumns columns = all_columns(want);
  auto written = write_csv(folder / (label + ".want.csv"), want, columns);
  if (!written || got.samples.empty()) return written;
  columns.plant = !got.plant.empty();
  return write_csv(folder / (label + ".got.csv"), got, columns);
}

}  // namespace

bool saves_traces(const std::filesystem::path& folder, const CaseResult& result) {
  return !folder.empty() && fails_a_run(result.verdict);
}

void save_traces(const std::filesystem::path& folder, const Subject& subject, const Trace& got,
                 const Trace& want, CaseResult& result) {
  const auto saved =
      write_traces(folder / result.case_id(), result.configuration().label(), subject, got, want);
  if (saved) return;
  result.reason += fmt::format("{}its traces are not saved: {}", result.reason.empty() ? "" : "; ",
                               saved.error().to_string());
}

}  // namespace attest
