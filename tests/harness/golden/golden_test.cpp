#include "tests/harness/golden/golden_test.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "harness/golden/golden_change.hpp"
#include "harness/golden/shared_golden.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

namespace fs = std::filesystem;

TEST_F(GoldenTest, IsAFileLikeItsCaseAndAnEntryOfItsProfile) {
  bless(root(), a_case());
  bless(root(), other_case());
  EXPECT_THAT(files(),
              UnorderedElementsAre(of_the_case, "px4-v1.5.5/tests/other_case.csv", of_the_profile));
  const auto golden = open(a_case());
  ASSERT_TRUE(golden) << golden.error().to_string();
  EXPECT_EQ(golden->file(), file());
  EXPECT_EQ(golden->origin().case_sha256, a_case().sha256);
  EXPECT_EQ(golden->origin().sha256, sha256(golden_of_profile(*read_file(file()), "px4-v1.5.5")));
  EXPECT_EQ(golden->origin().reason, "a test");
  EXPECT_FALSE(golden->is_of_port());
  EXPECT_TRUE(open(other_case())) << "an entry stays when another one is blessed";
}

TEST_F(GoldenTest, ACaseWithoutOneSaysHowToMakeIt) {
  EXPECT_THAT(error_of_open(a_case()),
              AllOf(HasSubstr("no golden for px4-v1.5.5/tests/the_case"),
                    HasSubstr("bless --filter 'px4-v1.5.5/tests/the_case'")));
}

TEST_F(GoldenTest, OfAnotherVersionOfTheCaseItIsStale) {
  bless(root(), a_case());
  EXPECT_THAT(error_of_open(a_case("level = \"exact\"\n")),
              AllOf(HasSubstr("the_case.csv: the golden is stale"), HasSubstr("bless --filter")));
}

TEST_F(GoldenTest, ARateThatWasNotBlessedIsAnError) {
  bless(root(), a_case());
  const auto golden = open(a_case());
  EXPECT_TRUE(golden->trace(at(333)));
  const auto trace = golden->trace(at(250));
  ASSERT_FALSE(trace);
  EXPECT_THAT(trace.error().message, HasSubstr("no trace for 250hz"));
}

TEST_F(GoldenTest, BytesThatWereNotBlessedAreAnError) {
  bless(root(), a_case());
  bless(root(), other_case());
  std::ofstream(file(), std::ios::app) << "\n";
  EXPECT_THAT(error_of_open(a_case()),
              AllOf(HasSubstr(file().string()), HasSubstr("is not the file that was blessed")));
  EXPECT_TRUE(open(other_case()));
  fs::remove(file());
  EXPECT_FALSE(open(a_case()));
}

TEST_F(GoldenTest, AnOriginThatWasEditedIsAnErrorAlsoOfBless) {
  bless(root(), a_case());
  std::ofstream(origins(), std::ios::app) << "\n";
  EXPECT_THAT(error_of_open(a_case()),
              AllOf(HasSubstr(origins().string()), HasSubstr("was changed after it was blessed")));
  const Goldens old(root());
  EXPECT_FALSE(NewGoldens(old).add(a_case(), made_by_reference(a_case()), {"a test"}));
}

TEST_F(GoldenTest, ThatWasBlessedAnewDuringTheRunIsAnError) {
  bless(root(), a_case());
  const auto at_start = std::make_shared<FileHashes>();
  at_start->add(origins(), *sha256_of_file(origins()));
  EXPECT_TRUE(Goldens(root() / ".", at_start).open(a_case()));
  bless(root(), other_case());
  EXPECT_TRUE(open(a_case()));
  const auto anew = Goldens(root(), at_start).open(a_case());
  ASSERT_FALSE(anew);
  EXPECT_EQ(anew.error().file, origins().string());
  EXPECT_THAT(anew.error().message, HasSubstr("changed during the run"));
}

// A suite with a base is judged by the reference where it has no golden. A lost one is no excuse.
TEST_F(GoldenTest, OfWhichOnlyTheFileOrOnlyTheOriginIsLeftIsStillOne) {
  bless(root(), a_case());
  EXPECT_TRUE(Goldens(root()).has(a_case()));
  EXPECT_FALSE(Goldens(root()).has(other_case()));
  fs::rename(file(), root() / "aside.csv");
  EXPECT_TRUE(Goldens(root()).has(a_case()));
  fs::rename(root() / "aside.csv", file());
  fs::remove(origins());
  EXPECT_TRUE(Goldens(root()).has(a_case()));
}

// A report names the reference, so it must be that which made the goldens.
TEST_F(GoldenTest, TheReferenceIsThePortThatMadeThem) {
  bless(root(), a_case());
  EXPECT_EQ(Goldens(root()).reference(), "");
  MadeGolden made = made_by_reference(other_case());
  made.inputs["100hz"] = "some";
  bless(root(), other_case(), made);
  EXPECT_EQ(Goldens(root()).reference(), Making::own_reference());
}

TEST_F(GoldenTest, OfAPortItIsForTheInputsThatThePortHad) {
  MadeGolden made = made_by_reference(a_case());
  const auto inputs = answers_of_reference(a_case());
  made.inputs["100hz"] = "another";
  bless(root(), a_case(), made);
  const auto golden = open(a_case());
  ASSERT_TRUE(golden);
  EXPECT_TRUE(golden->is_of_port());
  EXPECT_THAT(golden->check_inputs(inputs[0], at(100)).error().message,
              HasSubstr("the case has other inputs"));
}

class GoldenOfAFlight : public GoldenTest {
 protected:
  void SetUp() override {
    vehicle_.file = root().parent_path() / "bee.toml";
    for (const fs::path& file : vehicle_.files()) ASSERT_TRUE(write_file(file, "of a bee\n"));
    vehicle_.sha256 = vehicle_.mjcf_sha256 = sha256("of a bee\n");
  }

  // The horizons are 0.1 s, 0.2 s; the metrics 0, 1.
  MadeGolden flown(const std::vector<fs::path>& vehicle_files) const {
    MadeGolden made = made_by_reference(a_case());
    for (std::size_t i = 0; i < made.traces.size(); ++i) {
      made.traces[i].horizon_s = 0.1 * static_cast<double>(i + 1);
      made.traces[i].metrics = {{"settles", static_cast<double>(i)}};
    }
    for (const fs::path& file : vehicle_files) {
      made.models[file.filename().string()] = hashes_of(vehicle_).at(file.filename().string());
    }
    return made;
  }
  std::string error_of_vehicle() const {
    const auto checked = open(a_case())->check_vehicle(vehicle_);
    return checked ? "" : checked.error().message;
  }
  std::string change(const MadeGolden& made) const {
    return change_of_golden(a_case(), made, Goldens(root())).value_or("error");
  }

  Vehicle vehicle_;
};

TEST_F(GoldenOfAFlight, OfAVehicleThatItDoesNotListOrThatChangedItIsStale) {
  bless(root(), a_case(), flown({vehicle_.files()[0]}));
  EXPECT_THAT(error_of_vehicle(), HasSubstr("bee.xml is new since it was blessed"));
  bless(root(), a_case(), flown(vehicle_.files()));
  ASSERT_TRUE(write_file(vehicle_.file, "of another bee\n"));
  EXPECT_EQ(error_of_vehicle(), "") << "the vehicle was loaded before";
  vehicle_.sha256 = sha256("of another bee\n");
  EXPECT_THAT(error_of_vehicle(), HasSubstr("bee.toml has changed since it was blessed"));
  vehicle_.sha256 = vehicle_.mjcf_sha256;
  vehicle_.mjcf_sha256 = sha256("of another bee\n");
  EXPECT_THAT(error_of_vehicle(), HasSubstr("bee.xml has changed since it was blessed"));
}

TEST_F(GoldenOfAFlight, ReportsWhatBlessingWouldChange) {
  const MadeGolden made = flown(vehicle_.files());
  EXPECT_THAT(change(made), HasSubstr("new, 2 traces"));
  bless(root(), a_case(), made);
  EXPECT_EQ(change(made), "");
  MadeGolden other = made;
  other.traces[0].outputs.samples[3].out.vehicle_rates_setpoint.roll += 1;
  EXPECT_THAT(change(other), HasSubstr("1 of 2 traces, 1 ticks, 1 signals; at most by 1 in"));
  other = made;
  other.traces[0].ticks.back() += 1;
  EXPECT_THAT(change(other), HasSubstr("1 of 2 traces are replaced"));
  other = made;
  other.traces[1].horizon_s = 0.3;
  EXPECT_THAT(change(other), HasSubstr("horizons or metrics did"));
  other = made;
  other.models["bee.toml"] = sha256("of another bee\n");
  EXPECT_THAT(change(other), HasSubstr("the vehicle's files did"));
}

}  // namespace
}  // namespace attest
