#include "harness/trace/trace_file.hpp"

#include "harness/trace/csv.hpp"
#include "harness/trace/mixer_csv.hpp"

namespace attest {

bool is_streamed(const std::filesystem::path& path) { return !looks_like_mixer_csv(path); }

Result<Trace> open_trace(const std::filesystem::path& path, TraceNeed need) {
  return is_streamed(path) ? read_csv(path, need) : read_mixer_csv(path);
}

}  // namespace attest
