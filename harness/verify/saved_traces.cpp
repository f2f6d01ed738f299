#include "harness/verify/saved_traces.hpp"

#include <map>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "harness/compare/allowed_deviation.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

// `folder` itself is not made: if it is gone, a temporary folder was removed because attest has
// died, and must not appear again.
Result<void> make_below(std::filesystem::path folder, const std::filesystem::path& path) {
  for (const auto& name : path) {
    std::error_code failed;
    std::filesystem::create_directory(folder /= name, failed);
    if (failed) return fail_at(folder.string(), "cannot be made: " + failed.message());
    if (std::filesystem::is_symlink(folder)) {
      return fail_at(folder.string(), "is a link, which attest did not make");
    }
  }
  return {};
}

Result<void> write_traces(const TraceFiles& files, const std::string& label,
                          const ModuleUnderTest& subject, const JudgedTraces& traces) {
  const std::filesystem::path folder = files.want.parent_path();
  std::map<std::string, std::string> mixers;
  if (subject.module == Module::mixer) {
    for (const char* which : {".got", ".want", ".tolerance"}) mixers[label + which] = subject.mixer;
  }
  if (auto added = add_origin(folder, subject.profile, mixers); !added) return added;
  CsvColumns columns = all_columns(traces.want);
  const auto write = [](const std::filesystem::path& path, const Trace& trace,
                        const CsvColumns& of_trace) {
    return AtomicFile::open(path, AtomicFile::Special::replaced).and_then([&](AtomicFile&& file) {
      return write_csv(std::move(file), trace, of_trace);
    });
  };
  auto written = write(files.want, traces.want, columns);
  if (!written || traces.got.samples.empty()) return written;
  columns.plant = !traces.got.plant.empty();
  written = write(files.got, traces.got, columns);
  if (!written || traces.tolerances.level() == Level::events) return written;
  const Trace allowed = allowed_deviations(traces.want, traces.tolerances);
  return write(files.tolerance, allowed, all_columns(allowed));
}

std::string label_of(const VectorResult& result, Module module) {
  const std::string label = result.configuration().label();
  const bool is_second = result.plant_configuration && module == Module::attitude_unit;
  return is_second ? fmt::format("{}.{}", label, name_of(module)) : label;
}

}  // namespace

bool saves_traces(const std::filesystem::path& folder, const VectorResult& result) {
  return !folder.empty() && fails_a_run(result.verdict);
}

TraceFiles trace_files(const std::filesystem::path& folder, const VectorResult& result,
                       Module module) {
  const std::filesystem::path stem = folder / result.case_id() / label_of(result, module);
  const auto file = [&](const char* suffix) { return std::filesystem::path(stem) += suffix; };
  return {file(".got.csv"), file(".want.csv"), file(".tolerance.csv")};
}

void save_traces(const std::filesystem::path& folder, const ModuleUnderTest& subject,
                 const JudgedTraces& traces, VectorResult& result) {
  auto saved = make_below(folder, result.case_id());
  if (saved) {
    saved = write_traces(trace_files(folder, result, subject.module),
                         label_of(result, subject.module), subject, traces);
  }
  if (saved) return;
  result.reason += fmt::format("{}its traces are not saved: {}", result.reason.empty() ? "" : "; ",
                               saved.error().to_string());
}

}  // namespace attest
