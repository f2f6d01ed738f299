// Reads a whole trace into memory.
#include "harness/trace/csv.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

Result<Trace> read_all(Result<TraceReader> reader) {
  if (!reader) return tl::unexpected(reader.error());
  Trace trace;
  if (auto read = reader->next_part(whole_trace, trace); !read) {
    return tl::unexpected(read.error());
  }
  return trace;
}

}  // namespace

Result<Trace> read_csv(const std::filesystem::path& path, TraceNeed need) {
  return read_all(TraceReader::open(path, need));
}

Result<Trace> parse_csv(const TraceText& trace, const TraceText* base, TraceNeed need) {
  return read_all(TraceReader::open(trace, base, need));
}

}  // namespace attest
