#include "harness/golden/shared_golden.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

const std::string columns = "configurations,tick,out/a\n";

TEST(SharedGolden, ATraceOfSeveralProfilesIsWrittenOnce) {
  const GoldensByProfile goldens = {{"new", columns + "50hz 100hz,0,1\n,1,\n250hz,0,2\n"},
                                    {"old", columns + "50hz 100hz,0,1\n,1,\n250hz,0,3\n"}};
  const std::string file =
      "profiles,configurations,tick,out/a\n"
      "new old,50hz 100hz,0,1\n,,1,\n"
      "old,250hz,0,3\n"
      "new,250hz,0,2\n";
  EXPECT_EQ(joined(goldens), file);
  EXPECT_EQ(goldens_in(file), goldens);
}

TEST(SharedGolden, OfOtherConfigurationsOrRowsATraceIsAnother) {
  const GoldensByProfile goldens = {{"a", columns + "50hz,0,1\n"},
                                    {"b", columns + "50hz 100hz,0,1\n"},
                                    {"c", columns + "50hz,0,1\n,1,\n"}};
  EXPECT_EQ(goldens_in(joined(goldens)), goldens);
}

TEST(SharedGolden, EachProfileKeepsTheOrderOfItsTraces) {
  const GoldensByProfile goldens = {{"a", columns + "x,0,1\ny,0,2\nz,0,3\n"},
                                    {"b", columns + "z,0,3\ny,0,2\nx,0,1\n"},
                                    {"c", columns + "y,0,2\nz,0,3\n"}};
  EXPECT_EQ(goldens_in(joined(goldens)), goldens);
}

// A profile whose name begins like another one is another one.
TEST(SharedGolden, HasNoTraceOfAProfileThatItDoesNotName) {
  const std::string file = joined({{"px4-v1.17", columns + "50hz,0,1\n"}});
  for (const char* other : {"px4-v1.1", "px4-v1.178", "x4-v1.17", ""}) {
    EXPECT_EQ(golden_of_profile(file, other), columns) << other;
  }
}

TEST(SharedGolden, OfAnEditedTextIsAnotherTextAndNoCrash) {
  const std::string file =
      joined({{"a", columns + "50hz,0,1\n,1,2\n"}, {"b", columns + "x,0,1\n"}});
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_NE(goldens_in(file.substr(0, size)), goldens_in(file)) << size;
  }
  EXPECT_NE(golden_of_profile(file + "\n", "a"), golden_of_profile(file, "a"));
  EXPECT_EQ(golden_of_profile("profile" + file.substr(8), "a"), "");
  EXPECT_EQ(golden_of_profile("\n\na\n", "a"), "");
}

TEST(SharedGolden, ColumnsAreThoseOfTheHeader) {
  EXPECT_TRUE(have_same_columns(columns + "50hz,0,1\n", columns + "100hz,0,2\n"));
  EXPECT_FALSE(have_same_columns(columns, "configurations,tick,out/b\n"));
}

TEST(SharedGolden, NamesAreSeparatedBySpacesAndCommas) {
  EXPECT_TRUE(can_share("our-law_2"));
  for (const char* name : {"our law", "our,law", "our\nlaw", "\"law\""}) {
    EXPECT_FALSE(can_share(name)) << name;
  }
}

}  // namespace
}  // namespace attest
