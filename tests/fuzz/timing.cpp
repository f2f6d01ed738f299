// Timing files. A timing that is read, written and read again is the same.
#include "harness/loop/timing_file.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

void require_same(const TimingFile& a, const TimingFile& b) {
  require(a.case_id == b.case_id && a.case_sha256 == b.case_sha256, "the same case");
  require(a.configuration == b.configuration, "the same run configuration");
  require(a.duration_s == b.duration_s, "the same duration");
  require(a.ticks == b.ticks, "the same ticks");
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest;
  const auto file = fuzz::write("timing.json", fuzz::text_of(data, size));
  const auto timing = read_timing(file);
  if (!timing) {
    fuzz::require_readable(timing.error(), file);
    return 0;
  }
  const auto copy = fuzz::folder() / "copy.json";
  fuzz::require(write_timing(*timing, copy).has_value(), "it can be written");
  const auto again = read_timing(copy);
  fuzz::require(again.has_value(), "it can be read again");
  fuzz::require_same(*timing, *again);
  return 0;
}
