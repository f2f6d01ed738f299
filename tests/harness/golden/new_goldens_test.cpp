#include "harness/golden/new_goldens.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "harness/golden/shared_golden.hpp"
#include "tests/harness/golden/golden_test.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

namespace fs = std::filesystem;

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

TEST_F(GoldenTest, WithoutACaseItIsRemovedWithItsEntry) {
  bless(root(), a_case());
  bless(root(), other_case());
  const Goldens old(root());
  const std::string key = "px4-v1.5.5/tests/other_case";
  EXPECT_THAT(old.without_case("px4-v1.5.5", {key_of(a_case())}), testing::ElementsAre(key));
  NewGoldens goldens(old);
  ASSERT_TRUE(goldens.remove("px4-v1.5.5", key));
  EXPECT_TRUE(open(other_case())) << "it stays until the others are put in place";
  ASSERT_TRUE(goldens.put_in_place());
  EXPECT_THAT(files(), UnorderedElementsAre(of_the_case, of_the_profile));
  EXPECT_FALSE(open(other_case()));
  EXPECT_TRUE(open(a_case()));
}

class SharedByProfiles : public GoldenTest {
 protected:
  static constexpr const char* profiles[] = {"px4-v1.5.5", "px4-v1.3.4"};
  static constexpr const char* changed = "[control_state]\nroll_rate = 0.5\n";

  // A case of two profiles, as a case of one of them.
  Case shared(const std::string& profile, const std::string& body = "") const {
    Case both = a_case(body);
    both.profiles = {profiles[0], profiles[1]};
    return both.in_profile(profile);
  }

  void SetUp() override {
    for (const char* profile : profiles) bless(root(), shared(profile));
  }
};

TEST_F(SharedByProfiles, ItIsOneFileAndAnEntryOfEachProfile) {
  EXPECT_THAT(files(),
              UnorderedElementsAre(of_the_case, of_the_profile, "px4-v1.3.4/provenance.toml"));
  for (const char* profile : profiles) {
    const auto golden = open(shared(profile));
    ASSERT_TRUE(golden) << golden.error().to_string();
    EXPECT_TRUE(golden->trace(at(333)));
  }
  EXPECT_EQ(key_of(shared("px4-v1.3.4")), "px4-v1.5.5/tests/the_case");
  EXPECT_EQ(id_of("px4-v1.3.4", key_of(shared("px4-v1.3.4"))), shared("px4-v1.3.4").id());
}

TEST_F(SharedByProfiles, ANewGoldenOfOneProfileLeavesThatOfTheOther) {
  bless(root(), shared("px4-v1.3.4", changed));
  EXPECT_TRUE(open(shared("px4-v1.3.4", changed)));
  EXPECT_TRUE(open(shared("px4-v1.5.5")));
}

TEST_F(SharedByProfiles, AnEditOfATraceOfOneProfileIsAnErrorOfThatProfile) {
  bless(root(), shared("px4-v1.3.4", changed));
  auto goldens = goldens_in(*read_file(file()));
  goldens["px4-v1.3.4"] += ",99,\n";
  ASSERT_TRUE(write_file(file(), joined(goldens)));
  EXPECT_THAT(error_of_open(shared("px4-v1.3.4", changed)),
              AllOf(HasSubstr("is not the file that was blessed"),
                    HasSubstr("its traces of px4-v1.3.4 is another")));
  EXPECT_TRUE(open(shared("px4-v1.5.5")));
  // Bless leaves out what was not blessed.
  bless(root(), shared("px4-v1.5.5", changed));
  EXPECT_FALSE(goldens_in(*read_file(file())).contains("px4-v1.3.4"));
}

TEST_F(SharedByProfiles, TheGoldenOfAProfileThatIsGoneIsTakenOutOfTheFile) {
  const Goldens old(root());
  {
    NewGoldens goldens(old);
    ASSERT_TRUE(goldens.remove("px4-v1.3.4", key_of(a_case())));
    EXPECT_EQ(goldens.size(), 1u);
    ASSERT_TRUE(goldens.put_in_place());
  }
  EXPECT_TRUE(open(shared("px4-v1.5.5")));
  EXPECT_FALSE(open(shared("px4-v1.3.4")));
  EXPECT_FALSE(goldens_in(*read_file(file())).contains("px4-v1.3.4"));
}

TEST_F(SharedByProfiles, TheFileGoesWithItsLastProfile) {
  const Goldens old(root());
  NewGoldens goldens(old);
  for (const char* profile : profiles) ASSERT_TRUE(goldens.remove(profile, key_of(a_case())));
  EXPECT_EQ(goldens.size(), 2u);
  ASSERT_TRUE(goldens.put_in_place());
  EXPECT_THAT(files(), UnorderedElementsAre(of_the_profile, "px4-v1.3.4/provenance.toml"));
}

// Bless was killed after it had written the origins of one of the two profiles.
TEST_F(SharedByProfiles, AKilledBlessLeavesTheOldGoldenOfOneAndTheNewOneOfTheOther) {
  const std::string old = *read_file(file());
  const std::string old_origins = *read_file(origins());
  for (const char* profile : profiles) bless(root(), shared(profile, changed));
  fs::rename(file(), new_golden_file(file()));
  ASSERT_TRUE(write_file(file(), old));
  ASSERT_TRUE(write_file(origins(), old_origins));
  for (const bool is_finished : {false, true}) {
    EXPECT_TRUE(open(shared("px4-v1.3.4", changed))) << is_finished;
    EXPECT_TRUE(open(shared("px4-v1.5.5"))) << is_finished;
    ASSERT_TRUE(finish_killed_bless(root()));
  }
  EXPECT_FALSE(fs::exists(new_golden_file(file())));
}

TEST_F(SharedByProfiles, AGoldenOfOtherColumnsIsLeftOut) {
  MadeGolden made = made_by_reference(shared("px4-v1.3.4", changed));
  for (GoldenTrace& trace : made.traces) trace.horizon_s = 1;
  bless(root(), shared("px4-v1.3.4", changed), made);
  EXPECT_TRUE(open(shared("px4-v1.3.4", changed)));
  EXPECT_FALSE(open(shared("px4-v1.5.5")));
}

TEST_F(GoldenTest, AProfileThatAFileCannotNameIsAnError) {
  Case named = a_case();
  named.profile = "our law";
  named.profiles = {"our law"};
  const Goldens old(root());
  const auto added = NewGoldens(old).add(named, made_by_reference(a_case()), {"a test"});
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().message, HasSubstr("rename the profile"));
}

TEST_F(GoldenTest, AFolderThatCannotBeMadeIsAnError) {
  std::ofstream(root()) << "a file where the folder should be\n";
  const Goldens old(root());
  const auto added = NewGoldens(old).add(a_case(), made_by_reference(a_case()), {"a test"});
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().message, HasSubstr("cannot be made"));
}

}  // namespace
}  // namespace attest
