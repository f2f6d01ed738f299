#include "harness/report/text.hpp"

#include <gtest/gtest.h>

namespace attest {
namespace {

TEST(OneLine, JoinsLines) {
  EXPECT_EQ(one_line("  a\n\n b\tc \n"), "a b c");
  EXPECT_EQ(one_line(""), "");
}

TEST(ShellWord, QuotesOnlyWhatNeedsIt) {
  EXPECT_EQ(shell_word("lib:./build/libmine.so"), "lib:./build/libmine.so");
  EXPECT_EQ(shell_word("proc:python3 port.py"), "'proc:python3 port.py'");
  EXPECT_EQ(shell_word("$(reboot)"), "'$(reboot)'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(ShellQuoted, AnApostropheEndsTheQuotes) { EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'"); }

TEST(BrokenAt, BreaksLongLinesAtSpaces) {
  EXPECT_EQ(broken_at(12, "one two three four\nfive\n"), "one two\n    three\n    four\nfive\n");
  EXPECT_EQ(broken_at(12, "  alpha beta gamma"), "  alpha beta\n      gamma");
  EXPECT_EQ(broken_at(12, "exactly 12 c\n\n"), "exactly 12 c\n\n");
  EXPECT_EQ(broken_at(12, "a_word_that_is_longer b"), "a_word_that_is_longer\n    b");
  EXPECT_EQ(broken_at(12, "case: a_word_that_is_longer\n"), "case: a_word_that_is_longer\n");
  EXPECT_EQ(broken_at(0, "no line of a file is broken"), "no line of a file is broken");
}

TEST(BrokenAt, CountsWhatIsSeen) {
  EXPECT_EQ(broken_at(9, "\x1b[31mFAIL\x1b[0m four"), "\x1b[31mFAIL\x1b[0m four");
  EXPECT_EQ(broken_at(9, "\u00b5\u00b5\u00b5\u00b5 four"), "\u00b5\u00b5\u00b5\u00b5 four");
}

TEST(BrokenAt, CommandsStayWhole) {
  const char* const command = "  reproduce: attest run --port lib:./mine.so\n";
  EXPECT_EQ(broken_at(10, command), command);
}

TEST(Counted, HasAPlural) {
  EXPECT_EQ(counted(0, "error"), "0 errors");
  EXPECT_EQ(counted(1, "error"), "1 error");
  EXPECT_EQ(counted(2, "error"), "2 errors");
}

}  // namespace
}  // namespace attest
