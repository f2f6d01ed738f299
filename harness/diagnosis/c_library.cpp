#include "harness/diagnosis/c_library.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <string_view>
#include <utility>
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

// The calls for which the law takes the library's result: of these functions, or a single one.
struct Chosen {
  LibraryCalls set = 0;
  LibraryCall single = {};
};

// For each function, its calls for which the library had another result than attest.
using Differed = std::array<std::set<LibraryCall>, function_names.size()>;

// FloatWith has static functions, so these are variables of the thread that steps the law.
thread_local Chosen chosen;
thread_local Differed differed;

struct Caller {
  inline static thread_local std::string_view caller = "";
};

float choose(std::size_t function, float library, float own) {
  const bool same = std::bit_cast<std::uint32_t>(library) == std::bit_cast<std::uint32_t>(own);
  if (same || (std::isnan(library) && std::isnan(own))) return own;
  const auto single = fmt::format("{}@{}", function_names[function], Caller::caller);
  differed[function].insert(single);
  return (chosen.set >> function & 1) != 0 || chosen.single == single ? library : own;
}

struct ChosenFunctions : Caller {
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
  if (std::strcmp(id, ATTEST_EXTENSION_ATTITUDE_LAW) == 0) {
    return &cascade::AttitudeLawTable<ChosenFloat>::table;
  }
  return cascade::whole_reference()->extension(id);
}

constexpr attest_unit law_in_chosen =
    mc_att_control::UnitTable<mc_att_control::McAttControl<ChosenFloat>>::named(
        "attest-c-library", "of this machine", extension_in_chosen);

// The number of ticks at which the law has the port's outputs when it makes these calls.
Result<std::size_t> matches(Trace got, Chosen calls, const Declarations& port, const Case& the_case,
                            const Tolerances& tolerances) {
  chosen = std::move(calls);
  differed = {};
  AbiPort in_chosen(law_in_chosen);
  ModuleUnderTest subject = subject_of(the_case);
  subject.instances = Instances::one;  // on this thread
  Trace law = got;
  for (Sample& sample : law.samples) sample.clear_outputs();
  if (drive(in_chosen, subject, law)) return 0;
  fill_in(port.lacks.outputs, law, got);
  return law.samples.size() - compare(got, law, tolerances).deviating_ticks;
}

faults::Fault port(std::string_view id, std::string_view what) {
  return {id,          "",     faults::Stage::functions, what, "a result that is off by an ulp",
          "C library", nullptr};
}

constexpr const char* remedy =
    "link attest::math (with the starters: ATTEST_MATH=1), or judge at the level numeric";

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
        "calls {} of the C library, which on this machine {} not always correctly rounded: {}",
        fmt::join(names, ", "), names.size() == 1 ? "is" : "are", remedy);
    ports.push_back(port(id, what));
  }
  return ports;
}

// Adds the matches with single calls.
Result<LibraryMatches> with_single_calls(LibraryMatches matched,
                                         const std::vector<Differed>& differed_with,
                                         const Trace& got, const Declarations& port,
                                         const Case& the_case, const Tolerances& tolerances) {
  for (std::size_t i = 0; i < function_names.size(); ++i) {
    for (const LibraryCall& single : differed_with[0][i]) {
      // If no other call of the function ever differs, the law makes the same steps as with all.
      if (differed_with[1U << i][i] == std::set{single}) {
        matched.with_single[single] = matched.with_set[1U << i];
        continue;
      }
      const auto found = matches(got, {0, single}, port, the_case, tolerances);
      if (!found) return tl::unexpected(found.error());
      matched.with_single[single] = *found;
    }
  }
  return matched;
}

}  // namespace

std::size_t LibraryMatches::with(const LibraryCall& single) const {
  const auto found = with_single.find(single);
  return found == with_single.end() ? with_set[0] : found->second;
}

Result<LibraryMatches> library_matches(const Trace& got, const Declarations& port,
                                       const Case& the_case, const Tolerances& tolerances) {
  LibraryMatches matched;
  std::vector<Differed> differed_with;
  for (LibraryCalls calls = 0; calls < library_call_sets; ++calls) {
    const LibraryCalls others = calls & ~std::bit_floor(calls);
    // Without a difference in the last function, the law makes the same steps as without it.
    if (calls != 0 && differed_with[others][std::bit_width(calls) - 1].empty()) {
      differed_with.push_back(differed_with[others]);
      matched.with_set.push_back(matched.with_set[others]);
      continue;
    }
    const auto found = matches(got, {calls}, port, the_case, tolerances);
    if (!found) return tl::unexpected(found.error());
    differed_with.push_back(differed);
    matched.with_set.push_back(*found);
  }
  return with_single_calls(std::move(matched), differed_with, got, port, the_case, tolerances);
}

const faults::Fault& port_that_calls(LibraryCalls calls) {
  static const std::vector<faults::Fault> ports = make_ports();
  return ports[calls];
}

const faults::Fault& port_that_calls(const LibraryCall& single) {
  struct Described {
    std::string id, what;
    faults::Fault fault;
  };
  static auto& ports = *new std::map<LibraryCall, Described>;  // never destroyed
  const auto [place, is_new] = ports.try_emplace(single);
  Described& one = place->second;
  if (is_new) {
    const std::size_t at = single.find('@');
    one.id = "libm-" + single;
    one.what = fmt::format(
        "calls {} of the C library where the law has `{}`, and elsewhere a correctly rounded one. "
        "That of the C library is not always correctly rounded on this machine: {}",
        single.substr(0, at), single.substr(at + 1), remedy);
    one.fault = port(one.id, one.what);
  }
  return one.fault;
}

}  // namespace attest
