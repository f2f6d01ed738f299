#include "tests/harness/golden/blessed.hpp"

#include <gtest/gtest.h>

#include "harness/golden/make_golden.hpp"

namespace attest {

std::vector<GoldenTrace> answers_of_reference(const Case& the_case) {
  VehicleModels none("");
  Reference reference = Reference::own();
  auto made = make_golden(the_case, reference, none, [] { return false; });
  EXPECT_TRUE(made) << made.error().to_string();
  return made ? std::move(made->traces) : std::vector<GoldenTrace>();
}

void bless(const std::filesystem::path& golden_root, const Case& the_case) {
  const Case first =
      the_case.is_of_first_profile() ? the_case : the_case.in_profile(the_case.profiles[0]);
  const auto of_first = answers_of_reference(first);
  const GoldenBase base{of_first, golden_folder(golden_root, first)};
  auto golden = NewGolden::write(golden_root, the_case, answers_of_reference(the_case), {},
                                 {"a test"}, the_case.is_of_first_profile() ? nullptr : &base);
  ASSERT_TRUE(golden) << golden.error().to_string();
  const auto placed = golden->put_in_place();
  ASSERT_TRUE(placed) << placed.error().to_string();
}

}  // namespace attest
