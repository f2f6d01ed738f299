#include "harness/trace/provenance.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::Pair;

class ProvenanceFile : public testing::Test {
 protected:
  // The errors without the path: "2:1: ...", one a line.
  std::string error_of(std::string_view text) {
    const auto read = read_provenance(directory_.write("provenance.toml", text));
    if (read) return "";
    std::string shown = read.error().to_string();
    const std::string here = directory_.path().string() + "/provenance.toml:";
    std::size_t at = 0;
    while ((at = shown.find(here)) != std::string::npos) shown.erase(at, here.size());
    return shown;
  }

  TemporaryDirectory directory_;
};

TEST_F(ProvenanceFile, ReadsBackWhatWasWritten) {
  Provenance written;
  written.profile = "px4-v1.5.5";
  written.case_id = "px4-v1.5.5/large_angle/flip_roll_150";
  written.case_sha256 = "0123";
  written.reference = "attest 0.1.0";
  written.compiler = "gcc 12.2.0";
  written.reason = "it's the \"first\"";
  written.constants = {{"in/battery_status.scale", 0.1}, {"in/parameter.MC_ROLL_P", 6.5}};
  written.mixers = {{"4x", "R: 4x 10000 10000 10000 0"}};
  written.sha256 = {{"250hz.csv", "4567"}};
  written.horizon_s = {{"250hz-iris-ode", 3.996}};
  written.metrics = {{"250hz-iris-ode.settles", 0.5}, {"250hz-iris-ode.tilts", INFINITY}};
  written.models = {{"iris.toml", "89ab"}};
  const auto read = read_provenance(directory_.write("provenance.toml", to_toml(written)));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->profile, written.profile);
  EXPECT_EQ(read->case_id, written.case_id);
  EXPECT_EQ(read->case_sha256, written.case_sha256);
  EXPECT_EQ(read->reference, written.reference);
  EXPECT_EQ(read->compiler, written.compiler);
  EXPECT_EQ(read->reason, written.reason);
  EXPECT_EQ(read->constants, written.constants);
  EXPECT_EQ(read->mixers, written.mixers);
  EXPECT_EQ(read->sha256, written.sha256);
  EXPECT_EQ(read->horizon_s, written.horizon_s);
  EXPECT_EQ(read->metrics, written.metrics);
  EXPECT_EQ(read->models, written.models);
}

TEST_F(ProvenanceFile, IsWrittenAsAPersonWould) {
  Provenance provenance;
  provenance.profile = "px4-v1.5.5";
  provenance.constants = {{"in/battery_status.scale", 1},
                          {"in/updated.battery_status", 1},
                          {"in/vehicle_status.is_vtol", 0},
                          {"in/parameter.MC_ROLL_P", NAN}};
  EXPECT_EQ(to_toml(provenance),
            "profile = 'px4-v1.5.5'\n"
            "\n"
            "[constants]\n"
            "'in/battery_status.scale' = 1.0\n"
            "'in/parameter.MC_ROLL_P' = nan\n"
            "'in/updated.battery_status' = 1\n"
            "'in/vehicle_status.is_vtol' = 0\n");
}

TEST_F(ProvenanceFile, NeedsNothing) {
  EXPECT_EQ(error_of(""), "");
  EXPECT_EQ(error_of("[constants]\n"), "");
}

TEST_F(ProvenanceFile, NamesWhatIsWrongWithAConstant) {
  EXPECT_EQ(error_of("[constants]\n"
                     "timestamp = 1\n"
                     "'in/battery_status.skale' = 1\n"
                     "'in/battery_status.scale' = 1e39\n"
                     "'in/actuator_armed.armed' = 256\n"
                     "'in/vehicle_status.is_vtol' = 0.5\n"
                     "'in/vehicle_status.is_rotary_wing' = nan\n"
                     "'in/updated.battery_status' = 2\n"
                     "'in/parameter.' = 2\n"
                     "'in/parameter.P' = 'x'\n"),
            "2:1: `timestamp` cannot be a constant; record it as a column\n"
            "3:1: unknown signal `in/battery_status.skale`; did you mean "
            "`in/battery_status.scale`?\n"
            "4:1: 1e+39 is too large for `in/battery_status.scale`, a 32-bit float\n"
            "5:1: 256 is not a flag for `in/actuator_armed.armed`; write an integer from 0 to 255\n"
            "6:1: 0.5 is not a flag for `in/vehicle_status.is_vtol`; write an integer from 0 to "
            "255\n"
            "7:1: nan is not a flag for `in/vehicle_status.is_rotary_wing`; write an integer from "
            "0 to 255\n"
            "8:1: 2 is not a bit for `in/updated.battery_status`; write 0 or 1\n"
            "9:1: unknown signal `in/parameter.`\n"
            "10:1: `in/parameter.P` must be a number, found text");
}

TEST_F(ProvenanceFile, NamesUnknownKeysAndMissingFiles) {
  EXPECT_EQ(error_of("compilr = 'gcc'\n"), "1:1: unknown key `compilr`; did you mean `compiler`?");
  const std::string missing = (directory_.path() / "missing.toml").string();
  EXPECT_EQ(read_provenance(missing).error().to_string(),
            missing + ": cannot open the file: No such file or directory");
}

TEST_F(ProvenanceFile, KeepsConstantsThatAreNoOrdinaryNumbers) {
  const auto read = read_provenance(
      directory_.write("provenance.toml",
                       "[constants]\n'in/battery_status.scale' = -inf\n'in/parameter.A' = -0.0\n"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_THAT(read->constants,
              ElementsAre(Pair("in/battery_status.scale", -INFINITY), Pair("in/parameter.A", 0)));
  EXPECT_TRUE(std::signbit(read->constants.at("in/parameter.A")));
}

}  // namespace
}  // namespace attest
