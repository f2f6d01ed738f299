#include "harness/core/suggestion.hpp"

#include <gtest/gtest.h>

namespace attest {
namespace {

const std::vector<std::string> names = {"thrust", "roll_rate", "pitch_rate", "MC_ROLL_P", "x"};

TEST(Suggestion, NamesTheNearestCandidate) {
  EXPECT_EQ(suggestion("thurst", names), "; did you mean `thrust`?");
  EXPECT_EQ(suggestion("thrus", names), "; did you mean `thrust`?");
  EXPECT_EQ(suggestion("rol_rate", names), "; did you mean `roll_rate`?");
  EXPECT_EQ(suggestion("picth_rate", names), "; did you mean `pitch_rate`?");
}

TEST(Suggestion, CountsASwapOfNeighboursAsOneEdit) {
  EXPECT_EQ(suggestion("raet", {"rate"}), "; did you mean `rate`?");
  EXPECT_EQ(suggestion("raxx", {"rate"}), "");
}

TEST(Suggestion, TakesLettersOfOtherCaseForTheSame) {
  EXPECT_EQ(suggestion("mc_roll_p", names), "; did you mean `MC_ROLL_P`?");
}

TEST(Suggestion, IsEmptyWhenNothingIsNear) {
  EXPECT_EQ(suggestion("battery", names), "");
  EXPECT_EQ(suggestion("y", names), "");
  EXPECT_EQ(suggestion("", names), "");
  EXPECT_EQ(suggestion("thrust", {}), "");
  EXPECT_EQ(suggestion(std::string(1000, 't'), names), "");
}

TEST(Suggestion, NamesACandidateOfWhichTheLastPartIsGiven) {
  EXPECT_EQ(suggestion("v1.5.5", {"px4-v1.3.4", "px4-v1.5.5"}), "; did you mean `px4-v1.5.5`?");
  EXPECT_EQ(suggestion("1.5.5", {"px4-v1.3.4", "px4-v1.5.5"}), "; did you mean `px4-v1.5.5`?");
  EXPECT_EQ(suggestion("5", {"px4-v1.5.5"}), "");
}

TEST(Suggestion, NamesACandidateOfWhichTheBeginningIsGiven) {
  const std::vector<std::string> profiles = {"px4-v1.17", "px4-v1.5.5", "px4-v1.16.0"};
  EXPECT_EQ(suggestion("px4-v1.16", profiles), "; did you mean `px4-v1.16.0`?");
  EXPECT_EQ(suggestion("v1.5", profiles), "; did you mean `px4-v1.5.5`?");
  EXPECT_EQ(suggestion("px4-v1.1", profiles), "; did you mean `px4-v1.17`?");  // by its letters
}

TEST(Suggestion, NamesTheReleaseOfWhichTheLastNumberIsAnother) {
  const std::vector<std::string> profiles = {"px4-v1.18", "px4-v1.16.0", "px4-v1.15.4"};
  EXPECT_EQ(suggestion("px4-v1.18.0", profiles), "; did you mean `px4-v1.18`?");
  EXPECT_EQ(suggestion("v1.18.0", profiles), "; did you mean `px4-v1.18`?");
  EXPECT_EQ(suggestion("px4-v1.15.0", profiles), "; did you mean `px4-v1.15.4`?");
  EXPECT_EQ(suggestion("px4-v1.19.0", profiles), "; did you mean `px4-v1.16.0`?");  // its letters
}

TEST(Suggestion, NamesALongerNameOnlyIfNoneIsNear) {
  EXPECT_EQ(suggestion("attitude", {"rate_unit", "attitude_unit"}),
            "; did you mean `attitude_unit`?");
  EXPECT_EQ(suggestion("rate", {"rate_limit", "rates"}), "; did you mean `rates`?");
  EXPECT_EQ(suggestion("", {"_unit"}), "");
}

TEST(Suggestion, KnowsOtherNamesOfTheSame) {
  EXPECT_EQ(suggestion("c++", {"c", "cpp"}), "; did you mean `cpp`?");
  EXPECT_EQ(suggestion("--seconds", {"--seed", "--duration"}), "; did you mean `--duration`?");
  EXPECT_EQ(suggestion("--seconds", {"--rate"}), "");
}

TEST(Suggestion, AllowsAThirdOfTheLength) {
  EXPECT_EQ(suggestion("control_state.q[0]", {"in/control_state.q[0]"}),
            "; did you mean `in/control_state.q[0]`?");
  EXPECT_EQ(suggestion("abcxxx", {"abcdef"}), "");
}

}  // namespace
}  // namespace attest
