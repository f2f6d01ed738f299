#include "harness/golden/golden.hpp"

#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/core/file.hpp"
#include "harness/golden/golden_change.hpp"
#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/golden/blessed.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

namespace fs = std::filesystem;

RunConfiguration at(std::int64_t hertz) { return {Rate::hz(hertz), std::nullopt}; }

constexpr const char* two_rates = "rates_hz = [100, 333]\nrates_why = \"two\"\n";

class GoldenTest : public testing::Test {
 protected:
  fs::path root() const { return directory_.path() / "golden"; }
  Case a_case(const std::string& body = "") const { return case_of(two_rates + body); }
  fs::path folder() const { return golden_folder(root(), a_case()); }

  std::string error_of_open(const Case& the_case) const {
    const auto golden = Golden::open(root(), the_case);
    EXPECT_FALSE(golden);
    return golden ? "" : golden.error().to_string();
  }

  // Every file below the root, relative to it.
  std::set<std::string> files() const {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(root())) {
      if (!entry.is_directory()) found.insert(entry.path().lexically_relative(root()).string());
    }
    return found;
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(GoldenTest, StandsInAFolderLikeItsCase) {
  EXPECT_EQ(folder(), root() / "px4-v1.5.5" / "tests" / "the_case");
}

TEST_F(GoldenTest, ReadsBackWhatWasBlessed) {
  const Case the_case = a_case(
      "[unit]\njitter = 0.3\ndrop_ticks = [4]\n"
      "[parameters]\nMC_ROLL_P = { signal = \"step\", from = 5, to = 6, at_ticks = 5 }\n"
      "[control_state]\nroll_rate = { signal = \"step\", from = -0.0, to = nan, at_ticks = 8 }\n"
      "q = { tilt_deg = { signal = \"ramp\", from = 0, to = 90, end_ticks = 9 } }\n"
      "[battery_status]\nscale = inf\nperiod_ticks = 3\n");
  bless(root(), the_case);
  const auto golden = Golden::open(root(), the_case);
  ASSERT_TRUE(golden) << golden.error().to_string();
  const auto answers = answers_of_reference(the_case);
  for (std::size_t i = 0; i < the_case.rates.size(); ++i) {
    const auto read = golden->read(the_case.configurations()[i]);
    ASSERT_TRUE(read) << read.error().to_string();
    EXPECT_EQ(first_input_difference(*read, answers[i].trace), std::nullopt);
    EXPECT_TRUE(compare(answers[i].trace, *read, Tolerances(Level::exact)).agrees());
  }
}

TEST_F(GoldenTest, ProvenanceSaysWhatItWasMadeFrom) {
  bless(root(), a_case());
  const auto golden = Golden::open(root(), a_case());
  ASSERT_TRUE(golden);
  EXPECT_EQ(golden->provenance().profile, "px4-v1.5.5");
  EXPECT_EQ(golden->provenance().case_id, "px4-v1.5.5/tests/the_case");
  EXPECT_EQ(golden->provenance().case_sha256, a_case().sha256);
  EXPECT_EQ(golden->provenance().reason, "a test");
  EXPECT_EQ(golden->provenance().sha256.size(), 2u);
}

TEST_F(GoldenTest, ACaseWithoutOneSaysHowToMakeIt) {
  EXPECT_THAT(error_of_open(a_case()),
              AllOf(HasSubstr("no golden for px4-v1.5.5/tests/the_case"),
                    HasSubstr("attest bless --filter 'px4-v1.5.5/tests/the_case'")));
}

TEST_F(GoldenTest, OfAnotherVersionOfTheCaseItIsStale) {
  bless(root(), a_case());
  EXPECT_THAT(error_of_open(a_case("level = \"exact\"\n")),
              AllOf(HasSubstr("provenance.toml: the golden is stale"), HasSubstr("attest bless")));
}

TEST_F(GoldenTest, ARateThatWasNotBlessedIsAnError) {
  bless(root(), a_case());
  const auto trace = Golden::open(root(), a_case())->read(at(250));
  ASSERT_FALSE(trace);
  EXPECT_THAT(trace.error().message, HasSubstr("no golden 250hz.csv"));
}

TEST_F(GoldenTest, BytesThatWereNotBlessedAreAnError) {
  bless(root(), a_case());
  const fs::path file = folder() / "100hz.csv";
  std::ofstream(file, std::ios::app) << "\n";
  const auto golden = Golden::open(root(), a_case());
  const auto tampered = golden->read(at(100));
  ASSERT_FALSE(tampered);
  EXPECT_EQ(tampered.error().file, file.string());
  EXPECT_THAT(tampered.error().message, HasSubstr("is not the file that was blessed"));
  EXPECT_TRUE(golden->read(at(333)));
  fs::remove(file);
  EXPECT_FALSE(golden->read(at(100)));
}

TEST_F(GoldenTest, ThatWasBlessedAnewDuringTheRunIsAnError) {
  bless(root(), a_case());
  const fs::path provenance = folder() / "provenance.toml";
  FileHashes at_start;
  at_start.add(provenance, *sha256_of_file(provenance));
  EXPECT_TRUE(Golden::open(root() / ".", a_case(), &at_start));
  const std::string text = *read_file(provenance);
  const std::string toml = text.substr(0, text.rfind("# SHA-256"));
  ASSERT_TRUE(write_file(provenance, sealed(toml + "# another\n")));
  EXPECT_TRUE(Golden::open(root(), a_case()));
  const auto anew = Golden::open(root(), a_case(), &at_start);
  ASSERT_FALSE(anew);
  EXPECT_EQ(anew.error().file, provenance.string());
  EXPECT_THAT(anew.error().message, HasSubstr("changed during the run"));
}

// One profile feeds the setpoint forward, the other its change: one control differs.
class TwoProfiles : public GoldenTest {
 protected:
  void SetUp() override {
    first_ = a_case(
        "[parameters]\nMC_ROLLRATE_FF = 0.1\n"
        "[control_state]\nq = { tilt_deg = { signal = \"ramp\", from = 1, to = 9, end_ticks = 9 } "
        "}\n"
        "[vehicle_attitude_setpoint]\nthrust = 0.1\n");
    first_.profiles = {"px4-v1.5.5", "px4-v1.3.4"};
    other_ = first_.in_profile("px4-v1.3.4");
    bless(root(), first_);
    bless(root(), other_);
  }

  fs::path file(const Case& the_case) const {
    return golden_folder(root(), the_case) / "100hz.csv";
  }

  Case first_, other_;
};

TEST_F(TwoProfiles, TheBaseMustNotChangeDuringTheRun) {
  FileHashes at_start;
  for (const Case& the_case : {first_, other_}) {
    const fs::path provenance = golden_folder(root(), the_case) / "provenance.toml";
    at_start.add(provenance, *sha256_of_file(provenance));
  }
  EXPECT_TRUE(Golden::open(root(), other_, &at_start));
  at_start.add(golden_folder(root(), first_) / "provenance.toml", "another");
  const auto golden = Golden::open(root(), other_, &at_start);
  ASSERT_FALSE(golden);
  EXPECT_THAT(golden.error().to_string(),
              HasSubstr("px4-v1.5.5/tests/the_case/provenance.toml: changed during the run"));
}

TEST_F(TwoProfiles, EachIsReadWhole) {
  for (const Case& the_case : {first_, other_}) {
    const auto golden = Golden::open(root(), the_case);
    ASSERT_TRUE(golden) << golden.error().to_string();
    const Trace want = answers_of_reference(the_case)[0].trace;
    const auto read = golden->read(at(100));
    ASSERT_TRUE(read) << read.error().to_string();
    EXPECT_EQ(first_input_difference(*read, want), std::nullopt);
    EXPECT_TRUE(compare(want, *read, Tolerances(Level::exact)).agrees());
  }
}

TEST_F(TwoProfiles, TheOtherHoldsOnlyWhatDiffers) {
  std::ifstream other(file(other_));
  std::string header;
  std::getline(other, header);
  EXPECT_EQ(header, "timestamp,out/actuator_controls_0.control[0]");
  EXPECT_THAT(Golden::open(root(), other_)->provenance().constants, testing::IsEmpty());
}

TEST_F(TwoProfiles, BytesOfTheFirstThatWereNotBlessedAreAnErrorOfTheOther) {
  std::ofstream(file(first_), std::ios::app) << "\n";
  const auto read = Golden::open(root(), other_)->read(at(100));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().file, file(first_).string());
  EXPECT_THAT(read.error().message, HasSubstr("is not the file that was blessed"));
}

TEST_F(TwoProfiles, AProvenanceOfTheFirstThatWasEditedIsAnErrorOfTheOther) {
  const fs::path provenance = golden_folder(root(), first_) / "provenance.toml";
  std::ofstream(provenance, std::ios::app) << "\n";
  const auto golden = Golden::open(root(), other_);
  ASSERT_FALSE(golden);
  EXPECT_EQ(golden.error().file, provenance.string());
  EXPECT_THAT(golden.error().message, HasSubstr("was changed after it was blessed"));
}

TEST_F(TwoProfiles, AFileOfTheFirstThatTheOtherDoesNotListIsAnError) {
  const fs::path file = golden_folder(root(), other_) / provenance_name;
  auto provenance = read_provenance(file);
  ASSERT_TRUE(provenance);
  ASSERT_EQ(provenance->base_sha256.erase("100hz.csv"), 1u);
  ASSERT_TRUE(write_file(file, sealed(to_toml(*provenance))));
  const auto read = Golden::open(root(), other_)->read(at(100));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("is not the file that was blessed"));
}

TEST_F(TwoProfiles, WithoutTheFirstTheOtherIsAnError) {
  fs::remove_all(golden_folder(root(), first_));
  EXPECT_FALSE(Golden::open(root(), other_));
}

TEST_F(GoldenTest, IsNotInPlaceBeforeItIsPutThere) {
  {
    const auto written =
        NewGolden::write(root(), a_case(), answers_of_reference(a_case()), {}, {"a test"});
    ASSERT_TRUE(written);
    EXPECT_FALSE(fs::exists(folder()));
  }
  EXPECT_THAT(files(), UnorderedElementsAre());
  EXPECT_TRUE(fs::is_empty(root()));
}

TEST_F(GoldenTest, LeavesItsFilesAndNothingElse) {
  bless(root(), a_case());
  bless(root(), a_case());
  const std::string in = "px4-v1.5.5/tests/the_case/";
  EXPECT_THAT(files(),
              UnorderedElementsAre(in + "100hz.csv", in + "333hz.csv", in + "provenance.toml"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder().parent_path()), {}), 1);
}

TEST_F(GoldenTest, ReplacesTheOldOneAndItsRates) {
  bless(root(), a_case());
  const Case changed = case_of("rates_hz = [250]\nrates_why = \"one\"\n");
  bless(root(), changed);
  const std::string in = "px4-v1.5.5/tests/the_case/";
  EXPECT_THAT(files(), UnorderedElementsAre(in + "250hz.csv", in + "provenance.toml"));
  EXPECT_TRUE(Golden::open(root(), changed));
}

TEST_F(GoldenTest, TheOldOneStaysWhenTheNewCannotBePutInPlace) {
  bless(root(), a_case());
  auto written = NewGolden::write(root(), a_case(), answers_of_reference(a_case()), {}, {"again"});
  ASSERT_TRUE(written);
  fs::remove_all(folder().string() + ".new");
  EXPECT_FALSE(written->put_in_place());
  const auto golden = Golden::open(root(), a_case());
  ASSERT_TRUE(golden);
  EXPECT_EQ(golden->provenance().reason, "a test");
}

TEST_F(GoldenTest, AFolderThatCannotBeMadeIsAnError) {
  std::ofstream(root()) << "a file where the folder should be\n";
  const auto written =
      NewGolden::write(root(), a_case(), answers_of_reference(a_case()), {}, {"a test"});
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("cannot be made"));
}

class GoldenOfAFlight : public GoldenTest {
 protected:
  void SetUp() override {
    vehicle_.file = root().parent_path() / "bee.toml";
    for (const fs::path& file : vehicle_.files()) ASSERT_TRUE(write_file(file, "of a bee\n"));
    vehicle_.sha256 = vehicle_.mjcf_sha256 = sha256("of a bee\n");
  }

  // The horizons are 0.1 s, 0.2 s; the metrics 0, 1.
  std::vector<GoldenTrace> flown() const {
    auto traces = answers_of_reference(a_case());
    for (std::size_t i = 0; i < traces.size(); ++i) {
      traces[i].is_whole = false;
      traces[i].horizon_s = 0.1 * static_cast<double>(i + 1);
      traces[i].metrics = {{"settles", static_cast<double>(i)}};
    }
    return traces;
  }

  void bless_with(const std::vector<fs::path>& vehicle_files) {
    auto golden = NewGolden::write(root(), a_case(), flown(), vehicle_files, {"a test"});
    ASSERT_TRUE(golden) << golden.error().to_string();
    ASSERT_TRUE(golden->put_in_place());
  }

  Result<ReferenceFlight> read_at(std::int64_t hertz) const {
    return Golden::open(root(), a_case())->read_flight(at(hertz), vehicle_);
  }

  Vehicle vehicle_;
};

TEST_F(GoldenOfAFlight, EachConfigurationHasItsHorizonAndItsMetrics) {
  bless_with(vehicle_.files());
  const auto slow = read_at(100), fast = read_at(333);
  ASSERT_TRUE(slow) << slow.error().to_string();
  ASSERT_TRUE(fast) << fast.error().to_string();
  EXPECT_EQ(slow->horizon_s, 0.1);
  EXPECT_EQ(fast->horizon_s, 0.2);
  EXPECT_EQ(slow->metrics.at("settles"), 0);
  EXPECT_EQ(fast->metrics.at("settles"), 1);
}

TEST_F(GoldenOfAFlight, OfAVehicleThatItDoesNotListOrThatChangedItIsStale) {
  bless_with({vehicle_.files()[0]});
  ASSERT_FALSE(read_at(100));
  EXPECT_THAT(read_at(100).error().message, HasSubstr("bee.xml is new since it was blessed"));
  bless_with(vehicle_.files());
  ASSERT_TRUE(write_file(vehicle_.file, "of another bee\n"));
  EXPECT_TRUE(read_at(100)) << "the vehicle was loaded before";
  vehicle_.sha256 = sha256("of another bee\n");
  ASSERT_FALSE(read_at(100));
  EXPECT_THAT(read_at(100).error().message, HasSubstr("bee.toml has changed since it was blessed"));
  vehicle_.sha256 = vehicle_.mjcf_sha256;
  vehicle_.mjcf_sha256 = sha256("of another bee\n");
  EXPECT_THAT(read_at(100).error().message, HasSubstr("bee.xml has changed since it was blessed"));
}

TEST_F(GoldenOfAFlight, ReportsWhatBlessingWouldChange) {
  const MadeGolden made{flown(), vehicle_.files()};
  EXPECT_THAT(change_of_golden(a_case(), made, root()), HasSubstr("new, 2 traces"));
  bless_with(vehicle_.files());
  EXPECT_EQ(change_of_golden(a_case(), made, root()), "");
  MadeGolden other = made;
  other.traces[0].trace.samples[3].out.vehicle_rates_setpoint.roll += 1;
  EXPECT_THAT(change_of_golden(a_case(), other, root()),
              HasSubstr("1 of 2 traces, 1 ticks, 1 signals; at most by 1 in"));
  other = made;
  other.traces[1].horizon_s = 0.3;
  EXPECT_THAT(change_of_golden(a_case(), other, root()), HasSubstr("horizons or metrics did"));
  ASSERT_TRUE(write_file(vehicle_.file, "of another bee\n"));
  EXPECT_THAT(change_of_golden(a_case(), made, root()), HasSubstr("the vehicle's files did"));
}

}  // namespace
}  // namespace attest
