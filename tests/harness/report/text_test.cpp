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

TEST(Counted, HasAPlural) {
  EXPECT_EQ(counted(0, "error"), "0 errors");
  EXPECT_EQ(counted(1, "error"), "1 error");
  EXPECT_EQ(counted(2, "error"), "2 errors");
}

}  // namespace
}  // namespace attest
