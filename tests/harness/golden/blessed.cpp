#include "tests/harness/golden/blessed.hpp"

#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/port.hpp"

namespace attest {

std::vector<GoldenTrace> answers_of_reference(const Case& the_case) {
  const auto port = open_port("builtin");
  std::vector<GoldenTrace> traces;
  for (const RunConfiguration& configuration : the_case.configurations()) {
    Trace trace = stimulate(the_case, configuration.rate);
    const auto unit = (*port)->create(the_case.profile);
    const auto fault = drive(*unit, trace);
    EXPECT_FALSE(fault) << fault->what;
    traces.push_back({configuration, std::move(trace)});
  }
  return traces;
}

void bless(const std::filesystem::path& golden_root, const Case& the_case) {
  const Case first =
      the_case.is_of_first_profile() ? the_case : the_case.in_profile(the_case.profiles[0]);
  const auto of_first = answers_of_reference(first);
  const GoldenBase base{of_first, golden_folder(golden_root, first)};
  auto golden = NewGolden::write(golden_root, the_case, answers_of_reference(the_case), {},
                                 "a test", the_case.is_of_first_profile() ? nullptr : &base);
  ASSERT_TRUE(golden) << golden.error().to_string();
  const auto placed = golden->put_in_place();
  ASSERT_TRUE(placed) << placed.error().to_string();
}

}  // namespace attest
