#include "harness/golden/golden.hpp"

#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
constexpr const char* of_the_case = "px4-v1.5.5/tests/the_case.csv";
constexpr const char* of_the_profile = "px4-v1.5.5/provenance.toml";

class GoldenTest : public testing::Test {
 protected:
  fs::path root() const { return directory_.path() / "golden"; }
  fs::path file() const { return root() / of_the_case; }
  fs::path origins() const { return root() / of_the_profile; }
  Case a_case(const std::string& body = "") const { return case_of(two_rates + body); }
  Case other_case() const {
    Case other = a_case("level = \"exact\"\n");
    other.name = "other_case";
    return other;
  }

  Result<Golden> open(const Case& the_case) const { return Goldens(root()).open(the_case); }
  std::string error_of_open(const Case& the_case) const {
    const auto golden = open(the_case);
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

TEST_F(GoldenTest, IsAFileLikeItsCaseAndAnEntryOfItsProfile) {
  bless(root(), a_case());
  bless(root(), other_case());
  EXPECT_THAT(files(),
              UnorderedElementsAre(of_the_case, "px4-v1.5.5/tests/other_case.csv", of_the_profile));
  const auto golden = open(a_case());
  ASSERT_TRUE(golden) << golden.error().to_string();
  EXPECT_EQ(golden->file(), file());
  EXPECT_EQ(golden->origin().case_sha256, a_case().sha256);
  EXPECT_EQ(golden->origin().sha256, *sha256_of_file(file()));
  EXPECT_EQ(golden->origin().reason, "a test");
  EXPECT_FALSE(golden->is_of_port());
  EXPECT_TRUE(open(other_case())) << "an entry stays when another one is blessed";
}

TEST_F(GoldenTest, ACaseWithoutOneSaysHowToMakeIt) {
  EXPECT_THAT(error_of_open(a_case()),
              AllOf(HasSubstr("no golden for px4-v1.5.5/tests/the_case"),
                    HasSubstr("attest bless --filter 'px4-v1.5.5/tests/the_case'")));
}

TEST_F(GoldenTest, OfAnotherVersionOfTheCaseItIsStale) {
  bless(root(), a_case());
  EXPECT_THAT(error_of_open(a_case("level = \"exact\"\n")),
              AllOf(HasSubstr("the_case.csv: the golden is stale"), HasSubstr("attest bless")));
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

TEST_F(GoldenTest, IsNotInPlaceBeforeItIsPutThere) {
  {
    const Goldens old(root());
    NewGoldens goldens(old);
    ASSERT_TRUE(goldens.add(a_case(), made_by_reference(a_case()), {"a test"}));
    EXPECT_FALSE(fs::exists(file()));
  }
  EXPECT_THAT(files(), UnorderedElementsAre());
  EXPECT_TRUE(fs::is_empty(root()));
}

TEST_F(GoldenTest, ReplacesTheOldOneAndItsRates) {
  bless(root(), a_case());
  const Case changed = case_of("rates_hz = [250]\nrates_why = \"one\"\n");
  bless(root(), changed);
  EXPECT_THAT(files(), UnorderedElementsAre(of_the_case, of_the_profile));
  const auto golden = open(changed);
  ASSERT_TRUE(golden);
  EXPECT_TRUE(golden->trace(at(250)));
  EXPECT_FALSE(golden->trace(at(100)));
}

// A killed bless leaves the state between two system calls.
class KilledBless : public GoldenTest {
 protected:
  void SetUp() override {
    bless(root(), a_case());
    old_ = *read_file(file());
    old_origins_ = *read_file(origins());
    bless(root(), changed_);
    fs::rename(file(), new_golden_file(file()));
    ASSERT_TRUE(write_file(file(), old_));
  }

  Case changed_ = a_case("[control_state]\nroll_rate = 0.5\n");
  std::string old_, old_origins_;
};

TEST_F(KilledBless, AfterTheOriginsTheNewGoldenIsRead) {
  EXPECT_TRUE(open(changed_));
  ASSERT_TRUE(finish_killed_bless(root()));
  EXPECT_THAT(files(), UnorderedElementsAre(of_the_case, of_the_profile));
  EXPECT_TRUE(open(changed_));
}

TEST_F(KilledBless, BeforeTheOriginsTheOldGoldenIsRead) {
  ASSERT_TRUE(write_file(origins(), old_origins_));
  EXPECT_TRUE(open(a_case()));
  ASSERT_TRUE(finish_killed_bless(root()));
  EXPECT_THAT(files(), UnorderedElementsAre(of_the_case, of_the_profile));
  EXPECT_TRUE(open(a_case()));
  EXPECT_EQ(read_file(file()).value(), old_);
}

// What a person does with a provenance that has a merge conflict: restore it.
TEST_F(KilledBless, WithoutReadableOriginsTheNewGoldenStays) {
  const std::string good = *read_file(origins());
  fs::remove(file());
  std::ofstream(origins(), std::ios::app) << "<<<<<<< HEAD\n";
  EXPECT_FALSE(finish_killed_bless(root()));
  fs::remove(origins());
  EXPECT_TRUE(finish_killed_bless(root()));
  ASSERT_TRUE(write_file(origins(), good));
  EXPECT_TRUE(open(changed_));
}

TEST_F(KilledBless, FilesOfOthersStay) {
  fs::create_directories(root() / "recorded" / "mine");
  for (const char* name : {"notes.new", "recorded/mine/trace.csv.new", "px4-v1.5.5/tests/a.new",
                           "px4-v1.5.5/b.csv.new"}) {
    ASSERT_TRUE(write_file(root() / name, "of a person"));
    ASSERT_TRUE(finish_killed_bless(root()));
    EXPECT_EQ(read_file(root() / name).value_or(""), "of a person") << name;
  }
}

TEST_F(GoldenTest, OriginsThatChangedWhileBlessRanAreNotOverwritten) {
  bless(root(), a_case());
  const Goldens old(root());
  NewGoldens goldens(old);
  ASSERT_TRUE(goldens.add(a_case("[control_state]\nroll_rate = 0.5\n"), made_by_reference(a_case()),
                          {"a test"}));
  bless(root(), other_case());
  const auto placed = goldens.put_in_place();
  ASSERT_FALSE(placed);
  EXPECT_THAT(placed.error().message, HasSubstr("was changed while the new goldens were made"));
  EXPECT_TRUE(open(other_case()));
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

TEST_F(GoldenTest, WithoutACaseItIsRemovedWithItsEntry) {
  bless(root(), a_case());
  bless(root(), other_case());
  const Goldens old(root());
  EXPECT_THAT(old.without_case("px4-v1.5.5", {a_case().id()}),
              testing::ElementsAre("tests/other_case"));
  NewGoldens goldens(old);
  ASSERT_TRUE(goldens.remove("px4-v1.5.5", "tests/other_case"));
  EXPECT_TRUE(open(other_case())) << "it stays until the others are put in place";
  ASSERT_TRUE(goldens.put_in_place());
  EXPECT_THAT(files(), UnorderedElementsAre(of_the_case, of_the_profile));
  EXPECT_FALSE(open(other_case()));
  EXPECT_TRUE(open(a_case()));
}

TEST_F(GoldenTest, AFolderThatCannotBeMadeIsAnError) {
  std::ofstream(root()) << "a file where the folder should be\n";
  const Goldens old(root());
  const auto added = NewGoldens(old).add(a_case(), made_by_reference(a_case()), {"a test"});
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().message, HasSubstr("cannot be made"));
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
