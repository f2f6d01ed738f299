#include "harness/suite/message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::HasSubstr;
using testing::Not;

template <typename T>
std::optional<T> back(const Message& message) {
  const auto decoded = decode(encode(message));
  if (!decoded || !std::holds_alternative<T>(*decoded)) return std::nullopt;
  return std::get<T>(*decoded);
}

TEST(Message, IsReadBack) {
  EXPECT_EQ(back<TaskBegins>(TaskBegins{3})->task, 3u);
  EXPECT_TRUE(back<BatchDone>(BatchDone{}));
  const auto error = back<Error>(Error{"no golden", "a.toml", 3, 4});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->to_string(), "a.toml:3:4: no golden");
  CaseResult result;
  result.profile = "px4-v1.5.5";
  result.verdict = Verdict::crash;
  result.reason = "line\nbreak";
  EXPECT_EQ(back<CaseResult>(result)->reason, "line\nbreak");
}

TEST(Message, IsOneLine) { EXPECT_THAT(encode(Error{"two\nlines"}), Not(HasSubstr("\n"))); }

TEST(Message, WordsThatAreNotUtf8AreRepaired) {
  const auto error = back<Error>(Error{"\xff!"});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message, "\xef\xbf\xbd!");
}

TEST(Message, NothingIsTakenOnTrust) {
  for (const char* line :
       {"", "garbage", "{", "[]", "3", "null", "{}", "{\"begin\": -1}", "{\"begin\": \"1\"}",
        "{\"begin\": 1.5}", "{\"result\": {}}", "{\"result\": []}", "{\"error\": \"text\"}",
        "{\"error\": {}}", "{\"error\": {\"message\": 3}}", "\xff\xfe"}) {
    EXPECT_FALSE(decode(line)) << line;
  }
}

TEST(Message, AnErrorWithoutPlaceHasNone) {
  const auto decoded = decode("{\"error\": {\"message\": \"m\", \"line\": \"x\"}}");
  ASSERT_TRUE(decoded);
  EXPECT_EQ(std::get<Error>(*decoded).to_string(), "m");
}

}  // namespace
}  // namespace attest
