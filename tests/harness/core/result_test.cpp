#include "harness/core/result.hpp"

#include <gtest/gtest.h>

namespace attest {
namespace {

TEST(Error, ShowsOnlyWhatIsKnownOfItsPlace) {
  EXPECT_EQ((Error{"no such group", "", 0, 0}.to_string()), "no such group");
  EXPECT_EQ((Error{"is a directory", "a.csv", 0, 0}.to_string()), "a.csv: is a directory");
  EXPECT_EQ((Error{"no rows", "a.csv", 2, 0}.to_string()), "a.csv:2: no rows");
  EXPECT_EQ((Error{"not a number", "a.csv", 17, 203}.to_string()), "a.csv:17:203: not a number");
}

TEST(Error, IsMadeByTheReturnStatement) {
  const auto f = []() -> Result<int> { return fail_at("a.csv", "no rows", 2); };
  ASSERT_FALSE(f());
  EXPECT_EQ(f().error().line, 2);
  EXPECT_EQ(f().error().column, 0);
  const auto g = []() -> Result<int> { return fail("no such group"); };
  EXPECT_EQ(g().error().file, "");
}

TEST(Error, ShowsControlCharactersInsteadOfSendingThemToTheTerminal) {
  const auto made = [](const char* message) -> Result<int> { return fail_at("a.csv", message); };
  EXPECT_EQ(made("no group `\x1b[2J\x7f`").error().message, "no group `\\x1b[2J\\x7f`");
  EXPECT_EQ(made("one\na.csv:2: two").error().message, "one\na.csv:2: two");
  EXPECT_EQ(made("größer").error().message, "größer");
}

}  // namespace
}  // namespace attest
