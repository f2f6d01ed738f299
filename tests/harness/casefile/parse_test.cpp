#include "harness/casefile/parse.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace fs = std::filesystem;

TEST(ParseCase, NamesItByItsPlace) {
  const Case parsed = case_of("");
  EXPECT_EQ(parsed.id(), "px4-v1.5.5/tests/the_case");
  EXPECT_EQ(parsed.why, "a test");
  EXPECT_EQ(parsed.file_sha256, sha256(CaseFiles::with("")));
}

std::vector<std::string> profiles_in(const std::string& folder, const std::string& lines) {
  std::string text =
      "schema = 1\ngroup = \"tests\"\nwhy = \"a test\"\nduration_ticks = 10\n" + lines;
  if (folder.starts_with("px4-v1.1")) text += "module = \"rate_unit\"\n";
  const auto parsed = parse_case_text(text, "cases/" + folder + "/tests/a.toml");
  if (!parsed) throw std::invalid_argument(parsed.error().to_string());
  EXPECT_EQ(parsed->profile, folder);
  EXPECT_TRUE(parsed->is_of_first_profile());
  return parsed->profiles;
}

TEST(ParseCase, TheProfileOfItsFolderComesFirstAndTheOthersNewestFirst) {
  constexpr const char *v1_14 = "px4-v1.14.4", *v1_15 = "px4-v1.15.4", *v1_16 = "px4-v1.16.0",
                       *v1_17 = "px4-v1.17", *v1_18 = "px4-v1.18";
  const std::string since = "since = \"px4-v1.14.4\"\n", until = "until = \"px4-v1.15.4\"\n";
  EXPECT_THAT(profiles_in(v1_16, since), ElementsAre(v1_16, v1_18, v1_17, v1_15, v1_14));
  EXPECT_THAT(profiles_in(v1_15, since), ElementsAre(v1_15, v1_18, v1_17, v1_16, v1_14));
  EXPECT_THAT(profiles_in(v1_14, since), ElementsAre(v1_14, v1_18, v1_17, v1_16, v1_15));
  EXPECT_THAT(profiles_in(v1_14, since + until), ElementsAre(v1_14, v1_15));
  EXPECT_THAT(profiles_in(v1_15, until), ElementsAre(v1_15, v1_14));
  EXPECT_THAT(profiles_in(v1_16, "since = \"px4-v1.16.0\"\n"), ElementsAre(v1_16, v1_18, v1_17));
  EXPECT_THAT(
      profiles_in(v1_15, "profiles = [\"px4-v1.14.4\", \"px4-v1.16.0\", \"px4-v1.15.4\"]\n"),
      ElementsAre(v1_15, v1_16, v1_14));
  EXPECT_THAT(profiles_in("px4-v1.3.4", "since = \"px4-v1.3.4\"\n"),
              ElementsAre("px4-v1.3.4", "px4-v1.5.5"));
  EXPECT_THAT(profiles_in("our-law", "profiles = [\"px4-v1.3.4\", \"px4-v1.5.5\", \"our-law\"]\n"),
              ElementsAre("our-law", "px4-v1.5.5", "px4-v1.3.4"));
}

TEST(ParseCase, HasDefaults) {
  const Case parsed = case_of("");
  EXPECT_THAT(parsed.rates, testing::ElementsAreArray(standard_rates()));
  EXPECT_FALSE(parsed.exact_only);
  EXPECT_EQ(parsed.unit.start.on(Rate::hz(250)), std::chrono::seconds(5));
  EXPECT_EQ(parsed.unit.jitter, 0);
  EXPECT_THAT(parsed.unit.drop_ticks, IsEmpty());
  EXPECT_THAT(parsed.parameters, IsEmpty());
  EXPECT_THAT(parsed.tolerances, IsEmpty());
}

TEST(ParseCase, RatesAreSorted) {
  const Case parsed = case_of("rates_hz = [333, 62.5, 250]\nrates_why = \"three\"\n");
  EXPECT_THAT(parsed.rates, ElementsAre(Rate::hz(125, 2), Rate::hz(250), Rate::hz(333)));
}

TEST(ParseCase, ReadsTheUnitsTiming) {
  const Case parsed = case_of("[unit]\nstart_s = 0.5\njitter = 0.25\nseed = 7\ndrop_ticks = [3]\n");
  EXPECT_EQ(parsed.unit.start.amount, 0.5);
  EXPECT_EQ(parsed.unit.jitter, 0.25);
  EXPECT_EQ(parsed.unit.seed, 7u);
  EXPECT_THAT(parsed.unit.drop_ticks, ElementsAre(3));
}

TEST(ParseCase, ReadsToleranceOverrides) {
  const Case parsed = case_of(
      "level = \"exact\"\n[tolerance]\nwhy = \"reason\"\n"
      "\"vehicle_rates_setpoint.roll\" = { absolute = 0.5, relative = 0.25 }\n");
  EXPECT_TRUE(parsed.exact_only);
  EXPECT_EQ(parsed.tolerance_why, "reason");
  ASSERT_EQ(parsed.tolerances.size(), 1u);
  EXPECT_EQ(parsed.tolerances[0].channels, "vehicle_rates_setpoint.roll");
  EXPECT_EQ(parsed.tolerances[0].tolerance.absolute, 0.5);
  EXPECT_EQ(parsed.tolerances[0].tolerance.relative, 0.25);
}

TEST(ParseCase, TheToleranceOfAFieldOverridesThatOfItsTopic) {
  const Case parsed = case_of(
      "[tolerance]\nwhy = \"reason\"\n"
      "\"vehicle_rates_setpoint.roll\" = { absolute = 0.5 }\n"
      "\"vehicle_rates_setpoint\" = { absolute = 0.25 }\n");
  Tolerances tolerances;
  for (const auto& [channels, tolerance] : parsed.tolerances) tolerances.set(channels, tolerance);
  const auto of = [&](std::string_view name) {
    return tolerances.of(*find_channel(Module::mc_att_control, name)).absolute;
  };
  EXPECT_EQ(of("out/vehicle_rates_setpoint.roll"), 0.5);
  EXPECT_EQ(of("out/vehicle_rates_setpoint.yaw"), 0.25);
}

TEST(ParseCase, EveryTopicIsThereOnceInTheOrderOfItsBits) {
  const Case parsed = case_of("[battery_status]\nscale = 0.9\n");
  ASSERT_EQ(parsed.topics.size(), updated_topics(Module::mc_att_control).size());
  EXPECT_EQ(parsed.topics[0].topic, "control_state");
  EXPECT_EQ(parsed.topics[0].updated_bit, 0u);
  for (std::size_t i = 1; i < parsed.topics.size(); ++i) {
    EXPECT_EQ(parsed.topics[i].topic, updated_topics(Module::mc_att_control)[i - 1]);
    EXPECT_EQ(parsed.topics[i].updated_bit, 1u << (i - 1));
  }
}

TEST(ParseCase, ARelativePathHasTheSameFolders) {
  const CaseFiles files;
  const fs::path file = files.write("tests", "the_case", CaseFiles::with(""));
  const fs::path folder = fs::relative(file.parent_path());
  EXPECT_TRUE(parse_case(folder / "." / "the_case.toml"));
  EXPECT_TRUE(parse_case(folder / ".." / "tests" / "the_case.toml"));
}

TEST(ParseCase, AFileThatIsNotThereIsAnError) {
  const auto parsed = parse_case("nowhere/px4-v1.5.5/tests/the_case.toml");
  ASSERT_FALSE(parsed);
  EXPECT_THAT(parsed.error().file, HasSubstr("nowhere"));
}

TEST(FindCaseFiles, AreAllBelowInTheOrderOfTheirPaths) {
  const CaseFiles files;
  const fs::path b = files.write("b", "x", "");
  const fs::path a2 = files.write("a", "2", "");
  const fs::path a1 = files.write("a", "1", "");
  std::ofstream(files.folder() / "README.md") << "not a case\n";
  const auto found = find_case_files({files.folder()});
  ASSERT_TRUE(found);
  EXPECT_THAT(*found, ElementsAre(a1, a2, b));
}

TEST(FindCaseFiles, ALaterFolderReplacesFilesWithTheSamePath) {
  const CaseFiles below, above;
  below.write("a", "same", "");
  const fs::path only_below = below.write("a", "other", "");
  const fs::path same = above.write("a", "same", "");
  const fs::path only_above = above.write("b", "new", "");
  const auto found = find_case_files({below.folder(), above.folder()});
  ASSERT_TRUE(found);
  EXPECT_THAT(*found, ElementsAre(only_below, same, only_above));
}

TEST(FindCaseFiles, AnEmptyOrMissingFolderIsAnError) {
  const TemporaryDirectory empty;
  const auto none = find_case_files({empty.path()});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("no case files"));
  const auto missing = find_case_files({empty.path() / "missing"});
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace attest
