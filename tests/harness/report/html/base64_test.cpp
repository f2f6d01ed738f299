#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/report/html/plot_data.hpp"

namespace attest {
namespace {

// The inverse, written independently: a table lookup for each digit.
std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6) | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((bits >> count) & 255u);
  }
  return bytes;
}

TEST(Base64, HasTheTestVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Base64, NumbersAreLittleEndian) {
  const float one[] = {1.0f};  // 0x3f800000
  EXPECT_EQ(base64(one), base64(std::string_view("\x00\x00\x80\x3f", 4)));
}

RC_GTEST_PROP(Base64, DecodesToTheSameBytes, (const std::string& bytes)) {
  RC_ASSERT(base64(bytes).size() % 4 == 0u);
  RC_ASSERT(decoded(base64(bytes)) == bytes);
}

RC_GTEST_PROP(Base64, KeepsTheBitsOfEveryFloat, (const std::vector<std::uint32_t>& bits)) {
  std::vector<float> numbers;
  for (const std::uint32_t each : bits) numbers.push_back(std::bit_cast<float>(each));
  const std::string bytes = decoded(base64(numbers));
  RC_ASSERT(bytes.size() == 4 * bits.size());
  // RC_ASSERT evaluates both sides of ||, and memcmp must not get a null pointer.
  if (bits.empty()) return;
  RC_ASSERT(std::memcmp(bytes.data(), bits.data(), bytes.size()) == 0);
}

}  // namespace
}  // namespace attest
