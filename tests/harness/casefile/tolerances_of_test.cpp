#include <gtest/gtest.h>

#include "harness/casefile/case.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

TEST(TolerancesOf, TheLsbOfAPortIsAllowedInAdditionToTheToleranceOfTheCase) {
  const Case strict =
      case_of("[tolerance]\nwhy = \"x\"\nvehicle_rates_setpoint = { absolute = 1e-9 }\n");
  const std::size_t channel =
      *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.roll");
  const auto absolute = [&](std::optional<int> bits) {
    return tolerances_of(strict, Level::numeric, bits, 100).of(channel).absolute;
  };
  EXPECT_EQ(absolute(std::nullopt), 1e-9);
  EXPECT_GT(absolute(22), 1.0 / (1 << 22));
}

}  // namespace
}  // namespace attest
