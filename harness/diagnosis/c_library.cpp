#include "harness/diagnosis/c_library.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/cascade/rate_unit_definition.hpp"
#include "controller/cascade/unit_table.hpp"
#include "controller/cascade/whole.hpp"
#include "controller/elementary/float_with.hpp"
#include "controller/mc_att_control/mc_att_control_definition.hpp"
#include "controller/mc_att_control/unit_table.hpp"
#include "harness/compare/compare.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/abi_port.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

constexpr std::array<const char*, 6> function_names = {"sinf",  "cosf", "asinf",
                                                       "acosf", "expf", "atan2f"};
static_assert(library_call_sets == 1 << function_names.size());

// FloatWith has static functions, so the choice is a variable of the thread that steps the law.
thread_local LibraryCalls chosen = 0;
// The functions of which the library had another result than attest, in a call of the law.
thread_local LibraryCalls differed = 0;

float choose(std::size_t function, float library, float own) {
  const LibraryCalls call = 1U << function;
  const bool same = std::bit_cast<std::uint32_t>(library) == std::bit_cast<std::uint32_t>(own);
  if (same || (std::isnan(library) && std::isnan(own))) return own;
  differed |= call;
  return (chosen & call) != 0 ? library : own;
}

struct ChosenFunctions {
  static float sin(float x) { return choose(0, std::sin(x), attest_sinf(x)); }
  static float cos(float x) { return choose(1, std::cos(x), attest_cosf(x)); }
  static float asin(float x) { return choose(2, std::asin(x), attest_asinf(x)); }
  static float acos(float x) { return choose(3, std::acos(x), attest_acosf(x)); }
  static float exp(float x) { return choose(4, std::exp(x), attest_expf(x)); }
  static float atan2(float y, float x) { return choose(5, std::atan2(y, x), attest_atan2f(y, x)); }
};
using ChosenFloat = elementary::FloatWith<ChosenFunctions>;

// The other modules call no such function.
const void* extension_in_chosen(const char* id) noexcept {
  if (std::strcmp(id, ATTEST_EXTENSION_ATTITUDE_UNIT) == 0) {
    return &cascade::AttitudeUnitTable<ChosenFloat>::table;
  }
  return cascade::whole_reference()->extension(id);
}

constexpr attest_unit law_in_chosen =
    mc_att_control::UnitTable<mc_att_control::McAttControl<ChosenFloat>>::named(
        "attest-c-library", "of this machine", extension_in_chosen);

// The number of ticks at which the law has the port's outputs when it makes these calls.
Result<std::size_t> matches(Trace got, LibraryCalls calls, const Declarations& port,
                            const Case& the_case, const Tolerances& tolerances) {
  chosen = calls;
  differed = 0;
  AbiPort in_chosen(law_in_chosen);
  ModuleUnderTest subject = subject_of(the_case);
  subject.instances = Instances::one;  // on this thread
  Trace law = got;
  for (Sample& sample : law.samples) sample.clear_outputs();
  if (drive(in_chosen, subject, law)) return 0;
  if (port.is_recorded) fill_in(port.not_recorded, law, got);
  return law.samples.size() - compare(got, law, tolerances).deviating_ticks;
}

std::vector<faults::Fault> make_ports() {
  // Never destroyed, because the faults refer to these texts.
  static auto& texts = *new std::array<std::array<std::string, 2>, library_call_sets>;
  std::vector<faults::Fault> ports;
  for (LibraryCalls calls = 0; calls < library_call_sets; ++calls) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < function_names.size(); ++i) {
      if ((calls >> i & 1) != 0) names.emplace_back(function_names[i]);
    }
    auto& [id, what] = texts[calls];
    id = fmt::format("libm-{}", fmt::join(names, "-"));
    what = fmt::format(
        "calls {} of the C library, which on this machine {} not always correctly rounded: link "
        "attest::math (with the starters: ATTEST_MATH=1), or judge at the level numeric",
        fmt::join(names, ", "), names.size() == 1 ? "is" : "are");
    ports.push_back({id, "", faults::Stage::functions, what, "a result that is off by an ulp",
                     "C library", nullptr});
  }
  return ports;
}

}  // namespace

Result<LibraryMatches> library_matches(const Trace& got, const Declarations& port,
                                       const Case& the_case, const Tolerances& tolerances) {
  LibraryMatches matched;
  std::vector<LibraryCalls> differed_with;
  for (LibraryCalls calls = 0; calls < library_call_sets; ++calls) {
    const LibraryCalls last = std::bit_floor(calls), others = calls & ~last;
    // Without a difference in the last function, the law makes the same steps as without it.
    if (calls != 0 && (differed_with[others] & last) == 0) {
      differed_with.push_back(differed_with[others]);
      matched.push_back(matched[others]);
      continue;
    }
    const auto found = matches(got, calls, port, the_case, tolerances);
    if (!found) return tl::unexpected(found.error());
    differed_with.push_back(differed);
    matched.push_back(*found);
  }
  return matched;
}

const faults::Fault& port_that_calls(LibraryCalls calls) {
  static const std::vector<faults::Fault> ports = make_ports();
  return ports[calls];
}

}  // namespace attest
