#include "harness/trace/trace_file.hpp"

#include "harness/trace/csv.hpp"
#include "harness/trace/mixer_csv.hpp"

namespace attest {

Result<Trace> open_trace(const std::filesystem::path& path, TraceNeed need) {
  return looks_like_mixer_csv(path) ? read_mixer_csv(path) : read_csv(path, need);
}

}  // namespace attest
