#include "harness/core/printable.hpp"

#include <gtest/gtest.h>

namespace attest {
namespace {

TEST(Printable, KeepsTextInAnyLanguage) {
  const std::string text = "tilt 30° – Überschlag\n\t転 \xf0\x9f\x9a\x81";
  EXPECT_EQ(printable(text), text);
}

TEST(Printable, ShowsControlCharactersInsteadOfObeyingThem) {
  EXPECT_EQ(printable(std::string_view("\x1b[2J\x00\x7f\r", 7)), "\\x1b[2J\\x00\\x7f\\x0d");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");  // U+009B, the one-byte CSI of some terminals
}

TEST(Printable, ShowsBytesThatAreNotUtf8) {
  EXPECT_EQ(printable("a\xff"
                      "b"),
            "a\\xffb");
  EXPECT_EQ(printable("\xc3"), "\\xc3");                    // cut off
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");           // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(Printable, ShowsWhatXmlCannotHold) {
  EXPECT_EQ(printable("\xef\xbf\xbf"), "\\xef\\xbf\\xbf");
  EXPECT_EQ(printable("\xef\xbf\xbd"), "\xef\xbf\xbd");  // U+FFFD is fine
}

TEST(PrintablePart, HasNoLineEnd) {
  EXPECT_EQ(printable_part("a\nb\tc\x1b"), "a\\x0ab\\x09c\\x1b");
  EXPECT_EQ(printable_part("30°"), "30°");
}

}  // namespace
}  // namespace attest
