#include "harness/compare/compare_parts.hpp"

namespace attest {

Result<Comparison> compare_parts(TraceParts& got, TraceParts& want, const Tolerances& tolerances) {
  const bool is_whole = tolerances.level() == Level::events;
  const std::size_t most = is_whole ? whole_trace : 100;
  TickComparer comparer(got.present(), want.present(), tolerances);
  Trace got_part, want_part;
  std::size_t got_ticks = 0, want_ticks = 0;
  // Both are read to their end, so that an error anywhere in a file is reported.
  do {
    const auto read_got = got.next_part(most, got_part);
    if (!read_got) return tl::unexpected(read_got.error());
    const auto read_want = want.next_part(most, want_part);
    if (!read_want) return tl::unexpected(read_want.error());
    if (is_whole) return compare(got_part, want_part, tolerances);
    comparer.add(got_part, want_part);
    got_ticks += got_part.samples.size();
    want_ticks += want_part.samples.size();
  } while (!got_part.samples.empty() || !want_part.samples.empty());
  return comparer.finish(got_ticks, want_ticks);
}

}  // namespace attest
