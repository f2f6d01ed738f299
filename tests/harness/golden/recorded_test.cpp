#include "harness/golden/recorded.hpp"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/trace/csv.hpp"
#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

const std::filesystem::path recorded = ATTEST_SOURCE_DIR "/golden/recorded";
const std::filesystem::path mixers = recorded / "mixer-v1.5.5";

TEST(Recorded, AControllersTraceIsOfTheProfileThatItsProvenanceNames) {
  const auto read = read_recorded(recorded / "px4-v1.3.4" / "fuzz_250hz.csv");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->subject.module, Module::mc_att_control);
  EXPECT_EQ(read->subject.profile, "px4-v1.3.4");
}

// A trace of the unit with this parameter, if it has a name, without provenance.
Recorded assumed(Module module, const std::string& parameter) {
  const TemporaryDirectory folder;
  Trace trace = stimulate(unit_case_of(module, "px4-v1.14.4", ""), Rate::hz(250));
  trace.present = channels_of(module);
  trace.parameters.clear();
  if (!parameter.empty()) trace.parameters.push_back({0, parameter, 1});
  const auto file = folder.path() / "trace.csv";
  EXPECT_TRUE(write_csv(file, trace, all_columns(trace)));
  const auto read = read_recorded(file);
  EXPECT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->subject.module, module);
  return *read;
}

TEST(Recorded, WithoutProvenanceTheProfileIsTheNewestReleasedThatHasTheUnit) {
  const Recorded attitude = assumed(Module::attitude_unit, "MC_YAW_WEIGHT");
  EXPECT_EQ(attitude.subject.profile, "px4-v1.16.0");
  EXPECT_THAT(attitude.notes, testing::ElementsAre(HasSubstr("judged as px4-v1.16.0, because")));
  EXPECT_EQ(assumed(Module::rate_unit, "MC_ROLLRATE_K").subject.profile, "px4-v1.16.0");
  EXPECT_EQ(assumed(Module::rate_unit, "").subject.profile, "px4-v1.16.0");
}

TEST(Recorded, WithoutProvenanceTheProfileHasTheParametersOfTheTrace) {
  EXPECT_EQ(assumed(Module::attitude_unit, "MC_REF_FF").subject.profile, "px4-v1.18");
}

TEST(Recorded, ColumnsThatAttestDoesNotHaveAreIgnoredWithANote) {
  const TemporaryDirectory folder;
  std::ifstream original(recorded / "px4-v1.5.5" / "fuzz_250hz.csv");
  std::filesystem::copy(recorded / "px4-v1.5.5" / "provenance.toml", folder.path());
  std::ofstream extended(folder.path() / "a.csv");
  std::string line;
  for (int row = 0; std::getline(original, line); ++row) {
    extended << (row == 0 ? "comment," : "any text,") << line << (row == 0 ? ",log/x" : ",")
             << "\n";
  }
  extended.close();
  const auto read = read_recorded(folder.path() / "a.csv");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_THAT(read->notes, testing::ElementsAre("columns ignored, because attest has no such "
                                                "signals: comment, log/x"));
  const auto plain = read_recorded(recorded / "px4-v1.5.5" / "fuzz_250hz.csv");
  EXPECT_EQ(read->trace.parameters, plain->trace.parameters);
  EXPECT_EQ(read->trace.samples.size(), plain->trace.samples.size());
  EXPECT_EQ(read->trace.samples.back().out.actuator_controls_0.control[1],
            plain->trace.samples.back().out.actuator_controls_0.control[1]);
}

TEST(Recorded, AMixersDefinitionStandsInItsProvenance) {
  const auto read = read_recorded(mixers / "4x_scaled_idle.csv");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->subject.module, Module::mixer);
  EXPECT_EQ(read->subject.mixer, "R: 4x 8000 9000 5000 1500");
}

TEST(Recorded, OrIsTheGeometryThatTheFileIsNamedAfter) {
  const TemporaryDirectory folder;
  std::filesystem::copy(mixers / "6x.csv", folder.path());
  const auto read = read_recorded(folder.path() / "6x.csv");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->subject.mixer, "R: 6x 10000 10000 10000 0");
  EXPECT_EQ(read->subject.profile, "px4-v1.5.5");

  std::filesystem::copy(mixers / "6x.csv", folder.path() / "flight.csv");
  const auto unknown = read_recorded(folder.path() / "flight.csv");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("mixer definition missing"));
}

TEST(Recorded, ADefinitionThatDoesNotFitIsAnError) {
  const auto none = read_recorded(mixers / "4x.csv", "", "R: 4q 1 1 1 0");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("mixer `R: 4q 1 1 1 0`"));
  const auto six = read_recorded(mixers / "4x.csv", "", "R: 6x 10000 10000 10000 0");
  ASSERT_FALSE(six);
  EXPECT_THAT(six.error().message, HasSubstr("has 4 rotors"));
}

TEST(Recorded, TheProfileThatTheUserNamesGoesBeforeThatOfTheFolder) {
  const auto read = read_recorded(recorded / "px4-v1.3.4" / "fuzz_250hz.csv", "px4-v1.5.5");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->subject.profile, "px4-v1.5.5");
}

// The file changes MC_ROLL_P at tick 2, and has a parameter that only px4-v1.5.5 has.
TEST(Recorded, PartsHaveTheParametersOfTheWhole) {
  const TemporaryDirectory folder;
  auto trace = read_csv(recorded / "px4-v1.5.5" / "fuzz_250hz.csv", TraceNeed::outputs);
  ASSERT_TRUE(trace) << trace.error().to_string();
  trace->keep_first(4);
  trace->parameters = {{0, "MC_ROLL_P", 6}, {0, "MC_TPA_BREAK", 1}, {2, "MC_ROLL_P", 7}};
  trace->samples[2].in.updated |= ATTEST_UPDATED_PARAMETER_UPDATE;
  const auto file = folder.path() / "trace.csv";
  ASSERT_TRUE(write_csv(file, *trace, all_columns(*trace)));
  auto parts = RecordedParts::open(file, "px4-v1.3.4");
  ASSERT_TRUE(parts) << parts.error().to_string();
  EXPECT_THAT(parts->notes(), testing::ElementsAre(HasSubstr("not set, because px4-v1.3.4")));
  const auto changes_of_parts = [&] {
    std::vector<std::vector<ParameterChange>> changes;
    EXPECT_TRUE(parts->rewind());
    EXPECT_TRUE(for_each_part(*parts, 2, [&](const Trace& part, std::size_t, bool) {
      changes.push_back(part.parameters);
      return true;
    }));
    return changes;
  };
  using Changes = std::vector<ParameterChange>;
  EXPECT_THAT(changes_of_parts(), testing::ElementsAre(Changes{{0, "MC_ROLL_P", 6}},
                                                       Changes{{0, "MC_ROLL_P", 7}}, Changes{}));
  parts->override_parameter({0, "MC_ROLL_P", 5});
  EXPECT_THAT(changes_of_parts(),
              testing::ElementsAre(Changes{{0, "MC_ROLL_P", 5}}, Changes{}, Changes{}));
}

// A parameter of another profile is left out with a note; a parameter of no profile is an error.
TEST(Recorded, AParameterOfNoProfileIsAnError) {
  const TemporaryDirectory folder;
  auto trace = read_csv(recorded / "px4-v1.5.5" / "fuzz_250hz.csv", TraceNeed::outputs);
  ASSERT_TRUE(trace) << trace.error().to_string();
  trace->parameters.push_back({0, "MC_ROLL_Q", 1});
  const auto file = folder.path() / "trace.csv";
  ASSERT_TRUE(write_csv(file, *trace, all_columns(*trace)));
  const auto read = read_recorded(file);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("unknown parameter `MC_ROLL_Q`"));
}

}  // namespace
}  // namespace attest
