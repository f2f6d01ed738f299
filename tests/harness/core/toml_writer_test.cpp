#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "harness/core/toml.hpp"

namespace attest {
namespace {

double read_back(double value) {
  TomlWriter writer;
  writer.set("constants", "in/battery_status.scale", value);
  const auto file = TomlFile::parse(writer.to_string(), "written");
  return file->root().table("constants").number("in/battery_status.scale");
}

TEST(TomlWriter, WritesInAlphabeticalOrder) {
  TomlWriter writer;
  writer.set("sha256", "250hz.csv", "abc");
  writer.set("", "profile", "px4-v1.5.5");
  writer.set("", "count", std::int64_t{3});
  writer.set("constants", "in/control_state.q[0]", 1.0);
  writer.set("constants", "in/battery_status.scale", -0.0);
  writer.set("constants", "in/actuator_armed.armed", std::int64_t{1});
  EXPECT_EQ(writer.to_string(),
            "count = 3\n"
            "profile = 'px4-v1.5.5'\n"
            "\n"
            "[constants]\n"
            "'in/actuator_armed.armed' = 1\n"
            "'in/battery_status.scale' = -0.0\n"
            "'in/control_state.q[0]' = 1.0\n"
            "\n"
            "[sha256]\n"
            "'250hz.csv' = 'abc'\n");
}

TEST(TomlWriter, WritesTablesInTables) {
  TomlWriter writer;
  writer.set("control_state", "roll_rate", "signal", "samples");
  writer.set("control_state", "roll_rate", "values", std::vector<double>{0.25, 1.5});
  writer.set("control_state", "publish_at_s", std::vector<double>{0.5});
  EXPECT_EQ(writer.to_string(),
            "[control_state]\n"
            "publish_at_s = [ 0.5 ]\n"
            "\n"
            "    [control_state.roll_rate]\n"
            "    signal = 'samples'\n"
            "    values = [ 0.25, 1.5 ]\n");
}

TEST(TomlWriter, ReplacesAKeyThatIsSetAgain) {
  TomlWriter writer;
  writer.set("t", "a", 1.5);
  writer.set("t", "a", "text");
  EXPECT_EQ(writer.to_string(), "[t]\na = 'text'\n");
}

TEST(TomlWriter, KeepsWhatIsNoOrdinaryNumber) {
  EXPECT_TRUE(std::isnan(read_back(std::nan(""))));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(read_back(infinity), infinity);
  EXPECT_EQ(read_back(-infinity), -infinity);
  EXPECT_TRUE(std::signbit(read_back(-0.0)));
  EXPECT_EQ(read_back(std::numeric_limits<double>::denorm_min()),
            std::numeric_limits<double>::denorm_min());
}

RC_GTEST_PROP(TomlWriter, KeepsEveryFloat, ()) {
  // At the nominal size all 32 bits vary.
  const auto bits = *rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint32_t>());
  const auto value = static_cast<double>(std::bit_cast<float>(bits));
  RC_PRE(!std::isnan(value));
  RC_ASSERT(std::bit_cast<std::uint64_t>(read_back(value)) == std::bit_cast<std::uint64_t>(value));
}

RC_GTEST_PROP(TomlCanonical, KeepsEveryBitOfANumber, ()) {
  const auto bits = *rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>());
  const auto value = std::bit_cast<double>(bits);
  RC_PRE(std::isfinite(value));
  TomlWriter writer;
  writer.set("", "x", value);
  const std::string canonical = TomlFile::parse(writer.to_string(), "written")->canonical();
  RC_ASSERT(canonical.starts_with("{\"x\":"));
  double read = 0;  // std::stod() refuses numbers below the smallest normal one
  std::from_chars(canonical.data() + 5, canonical.data() + canonical.size(), read);
  RC_ASSERT(std::bit_cast<std::uint64_t>(read) == bits);
}

TEST(TomlWriter, KeepsEveryText) {
  for (const std::string text : {"", "it's \"quoted\"", "two\nlines", "back\\slash", "'''", "\t",
                                 "gr\xC3\xB6\xC3\x9F", "R: 4x 8000 9000 5000 1500"}) {
    TomlWriter writer;
    writer.set("", "text", text);
    const auto file = TomlFile::parse(writer.to_string(), "written");
    ASSERT_TRUE(file) << file.error().to_string();
    EXPECT_EQ(file->root().text("text"), text);
  }
}

}  // namespace
}  // namespace attest
