// Reads a whole trace into memory.
#include "harness/trace/csv.hpp"

namespace attest {

Result<Trace> read_csv(const std::filesystem::path& path, TraceNeed need) {
  auto reader = TraceReader::open(path, need);
  if (!reader) return tl::unexpected(reader.error());
  Trace trace;
  if (auto read = reader->next_part(whole_trace, trace); !read) {
    return tl::unexpected(read.error());
  }
  return trace;
}

}  // namespace attest
