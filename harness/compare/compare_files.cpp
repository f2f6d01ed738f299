#include "harness/compare/compare_files.hpp"

#include <system_error>

#include "harness/trace/csv.hpp"

namespace attest {
namespace {

struct Side {
  TraceReader reader;
  Sample sample{};
  std::vector<ParameterChange> changes{};
  std::size_t ticks = 0;

  Result<bool> next() {
    auto more = reader.next(sample, changes);
    if (more && *more) ++ticks;
    return more;
  }
};

Result<Comparison> compare_whole(const std::filesystem::path& got,
                                 const std::filesystem::path& want, const Tolerances& tolerances) {
  const auto all_got = read_csv(got, TraceNeed::outputs);
  if (!all_got) return tl::unexpected(all_got.error());
  const auto all_want = read_csv(want, TraceNeed::outputs);
  if (!all_want) return tl::unexpected(all_want.error());
  return compare(*all_got, *all_want, tolerances);
}

}  // namespace

Result<Comparison> compare_files(const std::filesystem::path& got,
                                 const std::filesystem::path& want, const Tolerances& tolerances) {
  for (const auto& file : {got, want}) {
    std::error_code unknown;
    if (std::filesystem::is_fifo(file, unknown)) {
      return fail_at(file.string(), "is a pipe; write its content to a file first");
    }
  }
  if (tolerances.level() == Level::events) return compare_whole(got, want, tolerances);
  auto got_reader = TraceReader::open(got, TraceNeed::outputs);
  if (!got_reader) return tl::unexpected(got_reader.error());
  auto want_reader = TraceReader::open(want, TraceNeed::outputs);
  if (!want_reader) return tl::unexpected(want_reader.error());
  Side a{std::move(*got_reader)}, b{std::move(*want_reader)};
  TickComparer comparer(a.reader.present(), b.reader.present(), tolerances);
  while (true) {
    // Both are read to their end, so that an error anywhere in a file is reported.
    const auto more_a = a.next(), more_b = b.next();
    if (!more_a) return tl::unexpected(more_a.error());
    if (!more_b) return tl::unexpected(more_b.error());
    if (!*more_a && !*more_b) return comparer.finish(a.ticks, b.ticks);
    if (*more_a && *more_b) comparer.add(a.sample, b.sample, b.changes);
  }
}

}  // namespace attest
