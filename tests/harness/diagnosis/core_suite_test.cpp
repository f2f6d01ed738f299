#include "harness/diagnosis/core_suite.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/golden/blessed.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;
using testing::SizeIs;

class CoreSuiteTest : public testing::Test {
 protected:
  // A case of so many ticks at 100 and 250 Hz, with its golden.
  void add(const std::string& name, int ticks, const std::string& body) {
    const auto parsed = parse_case(files_.write(
        "tpa", name,
        fmt::format("schema = 1\nprofiles = [\"px4-v1.5.5\"]\ngroup = \"tpa\"\nwhy = \"a test\"\n"
                    "duration_ticks = {}\nrates_hz = [100, 250]\nrates_why = \"two\"\n{}",
                    ticks, body)));
    ASSERT_TRUE(parsed) << parsed.error().to_string();
    cases_.push_back({*parsed, parsed->configurations()});
    bless(golden(), cases_.back().the_case);
  }
  std::filesystem::path golden() const { return files_.folder().parent_path() / "golden"; }

  CoreOfModule core() const {
    const Goldens goldens(golden());
    VehicleModels none("");
    const auto cores = core_of(cases_, "px4-v1.5.5", goldens, none, {});
    EXPECT_TRUE(cores) << cores.error().to_string();
    return cores && cores->size() == 1 ? cores->front() : CoreOfModule();
  }

 private:
  CaseFiles files_;
  std::vector<SelectedCase> cases_;
};

constexpr const char* of_the_core =
    "[parameters]\nMC_TPA_BREAK = 0.3\nMC_TPA_SLOPE = 1\n[control_state]\nroll_rate = 0.3\n"
    "[vehicle_attitude_setpoint]\nthrust = 0.8\n";

TEST_F(CoreSuiteTest, AVectorThatCatchesNothingNewIsNotInIt) {
  add("loud", 10, of_the_core);
  const CoreOfModule alone = core();
  EXPECT_THAT(alone.vectors, Contains("px4-v1.5.5/tpa/loud@250hz"));
  EXPECT_GT(alone.faults, 0u);
  add("loud_too", 10, of_the_core);
  const CoreOfModule both = core();
  EXPECT_EQ(both.vectors, alone.vectors);
  EXPECT_EQ(both.faults, alone.faults);
  EXPECT_EQ(both.ticks, alone.ticks);
}

TEST_F(CoreSuiteTest, OfTwoVectorsThatCatchTheSameTheShorterIsInIt) {
  add("a_long", 12, "");
  add("short", 4, "");
  const CoreOfModule found = core();
  EXPECT_THAT(found.vectors, Contains("px4-v1.5.5/tpa/short@250hz"));
}

}  // namespace
}  // namespace attest
