#include "tests/harness/golden/blessed.hpp"

#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/golden/make_golden.hpp"
#include "harness/golden/reference.hpp"

namespace attest {

std::vector<Trace> answers_of_reference(const Case& the_case) {
  std::vector<Trace> answers;
  for (const LoopRate& rate : the_case.rates) {
    const auto outputs =
        reference_outputs(subject_of(the_case), stimulate(the_case, rate.motor_unit));
    EXPECT_TRUE(outputs) << outputs.error().to_string();
    answers.push_back(outputs.value_or(Trace{}));
  }
  return answers;
}

MadeGolden made_by_reference(const Case& the_case) {
  VehicleModels none("");
  GoldenSource source = GoldenSource::own();
  auto made = make_golden(the_case, source, none, [] { return false; });
  EXPECT_TRUE(made) << made.error().to_string();
  return made ? *std::move(made) : MadeGolden{};
}

void bless(const std::filesystem::path& golden_root, const Case& the_case, const MadeGolden& made) {
  const Goldens old(golden_root);
  NewGoldens goldens(old);
  const auto added = goldens.add(the_case, made, {"a test"});
  ASSERT_TRUE(added) << added.error().to_string();
  const auto placed = goldens.put_in_place();
  ASSERT_TRUE(placed) << placed.error().to_string();
}

void bless(const std::filesystem::path& golden_root, const Case& the_case) {
  bless(golden_root, the_case, made_by_reference(the_case));
}

}  // namespace attest
