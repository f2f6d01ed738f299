#include "harness/trace/trace_file.hpp"

#include "harness/core/rereadable_file.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/mixer_csv.hpp"

namespace attest {

bool is_streamed(const std::filesystem::path& path) { return !looks_like_mixer_csv(path); }

Result<Trace> open_trace(const std::filesystem::path& path, TraceNeed need) {
  // The file is opened twice: to look at its header, and to read it.
  const auto file = RereadableFile::open(path);
  if (!file) return tl::unexpected(file.error());
  auto trace =
      is_streamed(file->path()) ? read_csv(file->path(), need) : read_mixer_csv(file->path());
  if (!file->is_copy()) return trace;
  if (trace) {
    trace->source = path.string();
  } else {
    trace.error().file = path.string();
  }
  return trace;
}

}  // namespace attest
