#include "harness/casefile/select.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class SelectTest : public testing::Test {
 protected:
  void SetUp() override {
    add("attitude", "roll");
    add("attitude", "pitch");
    add("rates", "roll");
    add("rates", "slow", "rates_hz = [10, 250]\nrates_why = \"slow\"\n");
  }

  void add(const std::string& group, const std::string& name, const std::string& more = "") {
    files_.write(group, name,
                 fmt::format("schema = 1\nprofiles = [\"px4-v1.5.5\"]\ngroup = \"{}\"\n"
                             "why = \"a test\"\nduration_ticks = 10\n{}",
                             group, more));
  }

  // "group/name:number of rates" of what is selected.
  std::vector<std::string> select(const Selection& selection) const {
    const auto selected = select_cases({files_.folder()}, selection);
    if (!selected) return {selected.error().to_string()};
    std::vector<std::string> names;
    for (const auto& [the_case, rates] : *selected) {
      names.push_back(fmt::format("{}/{}:{}", the_case.group, the_case.name, rates.size()));
    }
    return names;
  }

  std::vector<std::string> filter(const std::string& pattern) const {
    Selection selection;
    selection.filters = {pattern};
    return select(selection);
  }

  CaseFiles files_;
};

TEST_F(SelectTest, EmptyListsSelectEverythingInOrder) {
  EXPECT_THAT(select({}), ElementsAre("attitude/pitch:11", "attitude/roll:11", "rates/roll:11",
                                      "rates/slow:2"));
}

TEST_F(SelectTest, FiltersMatchTheIdOrParts) {
  EXPECT_THAT(filter("px4-v1.5.5/rates/roll@333hz"), ElementsAre("rates/roll:1"));
  EXPECT_THAT(filter("px4-v1.5.5/rates/roll"), ElementsAre("rates/roll:11"));
  EXPECT_THAT(filter("rates/*"), ElementsAre("rates/roll:11", "rates/slow:2"));
  EXPECT_THAT(filter("rates/*@250hz"), ElementsAre("rates/roll:1", "rates/slow:1"));
  EXPECT_THAT(filter("roll"), ElementsAre("attitude/roll:11", "rates/roll:11"));
  EXPECT_THAT(filter("*@10hz"), ElementsAre("rates/slow:1"));
  EXPECT_THAT(filter("[ps]*"),
              AllOf(testing::Contains("attitude/pitch:11"), testing::Contains("rates/slow:2")));
}

// Only files that a filter can match are read. Two filters, because an idle one reads them all.
TEST_F(SelectTest, AFileIsReadForEachFormOfAPattern) {
  add("rates", "at@sign");
  for (const char* pattern :
       {"*/p?tch@250hz", "attitude/p*250hz", "*/pitch@250hz", "attitude/pitch@250hz",
        "px4-v1.5.5/attitude/pitch@250hz", "*titude/pitch@250hz", "attitude/[p]itch@250hz",
        "attitude/\\pitch@250hz", "attitude/p*@250hz"}) {
    Selection selection;
    selection.filters = {pattern, "rates/slow@250hz"};
    EXPECT_THAT(select(selection), ElementsAre("attitude/pitch:1", "rates/slow:1")) << pattern;
  }
  Selection selection;
  selection.filters = {"*/*250hz", "rates/slow@250hz"};
  EXPECT_THAT(select(selection), testing::SizeIs(5));
  selection.filters = {"at@sign", "pitch"};
  EXPECT_THAT(select(selection), ElementsAre("attitude/pitch:11", "rates/at@sign:11"));
}

TEST_F(SelectTest, AFileThatNoFilterCanMatchIsNotRead) {
  files_.write("rates", "malformed", "schema = ");
  EXPECT_THAT(filter("pitch"), ElementsAre("attitude/pitch:11"));
  EXPECT_THAT(filter("attitude/pitch@*"), ElementsAre("attitude/pitch:11"));
  EXPECT_THAT(filter("p*tch"), ElementsAre(testing::HasSubstr("malformed.toml")));
}

TEST_F(SelectTest, AFileIsACaseOfEachOfItsProfiles) {
  files_.write("rates", "shared",
               "schema = 1\nprofiles = [\"px4-v1.5.5\", \"px4-v1.3.4\"]\ngroup = \"rates\"\n"
               "why = \"a test\"\nduration_ticks = 10\n");
  Selection selection;
  selection.filters = {"shared"};
  const auto both = select_cases({files_.folder()}, selection);
  ASSERT_TRUE(both);
  ASSERT_EQ(both->size(), 2u);
  EXPECT_EQ((*both)[0].the_case.id(), "px4-v1.3.4/rates/shared");
  EXPECT_EQ((*both)[1].the_case.id(), "px4-v1.5.5/rates/shared");
  selection.profiles = {"px4-v1.3.4"};
  EXPECT_THAT(select(selection), ElementsAre("rates/shared:11"));
}

TEST_F(SelectTest, AnyOfSeveralFilters) {
  Selection selection;
  selection.filters = {"pitch", "slow"};
  EXPECT_THAT(select(selection), ElementsAre("attitude/pitch:11", "rates/slow:2"));
}

TEST_F(SelectTest, ByGroupAndRate) {
  Selection selection;
  selection.groups = {"rates"};
  selection.rates = {Rate::hz(10), Rate::hz(333)};
  EXPECT_THAT(select(selection), ElementsAre("rates/roll:1", "rates/slow:1"));
}

TEST_F(SelectTest, FlightsByVehiclePlantAndConfiguration) {
  for (const char* vehicle : {"iris", "hexa"}) files_.name_vehicle(vehicle);
  add("flight", "hover",
      "[flight]\nvehicles = [\"iris\", \"hexa\"]\nvehicles_why = \"two\"\n"
      "[flight.metrics.settles]\nmeasure = \"settling_time_s\"\nmax = 1\n");
  Selection selection;
  selection.vehicles = {"hexa"};
  EXPECT_THAT(select(selection), ElementsAre("flight/hover:6"));
  selection.plants = {"ode"};
  EXPECT_THAT(select(selection), ElementsAre("flight/hover:3"));
  selection.vehicles.clear();
  EXPECT_THAT(select(selection), ElementsAre("flight/hover:14"));
  EXPECT_THAT(filter("hover"), ElementsAre("flight/hover:28"));
  EXPECT_THAT(filter("flight/hover@250hz"), ElementsAre("flight/hover:2"));
  EXPECT_THAT(filter("*@100hz-hexa-*"), ElementsAre("flight/hover:2"));
  selection = {};
  selection.vehicles = {"irish"};
  EXPECT_THAT(select(selection)[0], HasSubstr("`irish`; did you mean `iris`?"));
  selection = {};
  selection.groups = {"attitude"};
  selection.vehicles = {"iris"};
  EXPECT_THAT(select(selection), ElementsAre("no selected case has a vehicle"));
  selection = {};
  selection.plants = {"gazebo"};
  EXPECT_THAT(select(selection)[0], HasSubstr("`gazebo`"));
}

TEST_F(SelectTest, NamesThatAreNotThereAreErrorsThatSayWhatIs) {
  Selection selection;
  selection.groups = {"atitude"};
  EXPECT_THAT(select(selection)[0], HasSubstr("no cases of group `atitude`; did you mean "
                                              "`attitude`?; there are attitude, rates"));
  selection = {};
  selection.profiles = {"px4-v1.5.6"};
  EXPECT_THAT(select(selection)[0], HasSubstr("no cases of profile `px4-v1.5.6`"));
  selection = {};
  selection.rates = {Rate::hz(251)};
  EXPECT_THAT(select(selection)[0], HasSubstr("no selected case runs at 251 Hz; there are 10, 50"));
  EXPECT_THAT(filter("rol")[0], HasSubstr("no case matches `rol`; did you mean `roll`?"));
  selection = {};
  selection.filters = {"roll", "pich", "slow"};
  EXPECT_THAT(select(selection)[0], HasSubstr("no case matches `pich`;"));
}

TEST_F(SelectTest, WhatIsExcludedIsLeftOut) {
  Selection selection;
  selection.excludes = {"attitude/*", "rates/*@10hz"};
  EXPECT_THAT(select(selection), ElementsAre("rates/roll:11", "rates/slow:1"));
  selection.filters = {"roll"};
  selection.excludes = {"attitude/*"};
  EXPECT_THAT(select(selection), ElementsAre("rates/roll:11"));
  selection.excludes = {"roll"};
  EXPECT_THAT(select(selection)[0], HasSubstr("no case matches the selection"));
  // There are such cases, though the filter does not select them.
  selection.filters = {"rates/*"};
  selection.excludes = {"attitude/*"};
  EXPECT_THAT(select(selection), ElementsAre("rates/roll:11", "rates/slow:2"));
}

TEST_F(SelectTest, AnExclusionThatLeavesNothingOutIsAnError) {
  Selection selection;
  selection.groups = {"rates"};
  selection.excludes = {"pitch"};
  EXPECT_THAT(select(selection)[0], HasSubstr("no case with --group rates matches `pitch`"));
}

TEST_F(SelectTest, AMalformedCaseIsAnErrorUnlessItCannotMatch) {
  add("broken", "one", "thurst = 1\n");
  EXPECT_THAT(select({})[0], HasSubstr("one.toml:6:1: unknown key `thurst`"));
  Selection selection;
  selection.groups = {"rates"};
  EXPECT_EQ(select(selection).size(), 2u);
}

TEST_F(SelectTest, ShardsAreAPartition) {
  std::vector<std::string> all;
  for (std::size_t index = 1; index <= 3; ++index) {
    Selection selection;
    selection.shard = {index, 3};
    for (const std::string& name : select(selection)) all.push_back(name);
  }
  EXPECT_THAT(all, testing::UnorderedElementsAreArray(select({})));
  Selection selection;
  selection.shard = {5, 5};
  EXPECT_THAT(select(selection)[0], HasSubstr("this shard is empty"));
}

// Flights take most of the time. Every second case would put both long ones into one shard.
TEST_F(SelectTest, ShardsTakeAboutEquallyLong) {
  for (const char* vehicle : {"iris", "hexa"}) files_.name_vehicle(vehicle);
  const std::string metric = "[flight.metrics.settles]\nmeasure = \"settling_time_s\"\nmax = 1\n";
  const std::string two = "[flight]\nvehicles = [\"iris\", \"hexa\"]\nvehicles_why = \"two\"\n";
  add("flight", "a", two + metric);
  add("flight", "b", "[flight]\nvehicles = [\"iris\"]\nvehicles_why = \"one\"\n" + metric);
  add("flight", "c", two + metric);
  Selection selection;
  selection.shard = {1, 2};
  const auto first = select(selection);
  selection.shard = {2, 2};
  const auto second = select(selection);
  EXPECT_NE(testing::Value(first, Contains("flight/a:28")),
            testing::Value(first, Contains("flight/c:28")));
  EXPECT_NE(testing::Value(second, Contains("flight/a:28")),
            testing::Value(second, Contains("flight/c:28")));
}

TEST(Shard, IsParsed) {
  const auto shard = Shard::parse("2/4");
  ASSERT_TRUE(shard);
  EXPECT_EQ(shard->index, 2u);
  EXPECT_EQ(shard->count, 4u);
  for (const char* text : {"", "2", "0/4", "5/4", "1/0", "2/4x", "x/4", "-1/4", "/", "2 /4"}) {
    const auto wrong = Shard::parse(text);
    ASSERT_FALSE(wrong) << text;
    EXPECT_THAT(wrong.error().message, HasSubstr("is not a shard"));
  }
}

}  // namespace
}  // namespace attest
