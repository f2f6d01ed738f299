#include "harness/verify/saved_traces.hpp"

#include <string>

#include "harness/trace/csv.hpp"

namespace attest {

Result<void> save_traces(const std::filesystem::path& folder, const CaseResult& result,
                         const Trace* got, const Trace& want) {
  if (folder.empty() || !fails_a_run(result.verdict)) return {};
  const std::string id = result.id();
  const std::filesystem::path place =
      folder / id.substr(0, id.rfind('@')) / id.substr(id.rfind('@') + 1);
  std::error_code failed;
  std::filesystem::create_directories(place.parent_path(), failed);
  if (failed) return fail_at(place.parent_path().string(), "cannot create: " + failed.message());
  CsvColumns columns = all_columns(want);
  if (auto written = write_csv(place.string() + ".want.csv", want, columns); !written || !got) {
    return written;
  }
  columns.plant = !got->plant.empty();
  return write_csv(place.string() + ".got.csv", *got, columns);
}

}  // namespace attest
