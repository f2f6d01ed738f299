#include "harness/core/toml_document.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/core/toml.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* iris_text =
    "mass_kg = 1.5  # of the airframe\n"
    "name = 'iris'\n"
    "inertia = [0.1, 0.2, 0.3]\n"
    "'q[1]' = 0.25\n"
    "[battery]\n"
    "cells = 3\n"
    "[rotors]\n"
    "r0 = { position_m = [1, 2, 3] }\n";

const TomlDocument& document() {
  static const auto parsed = TomlDocument::parse(iris_text, "iris.toml");
  return *parsed;
}

double number_in(const std::string& toml, const std::string& path) {
  return TomlDocument::parse(toml, "new.toml")->number(path)->value();
}

TEST(TomlDocument, FindsTheNumberAtAPath) {
  EXPECT_EQ(*document().number("mass_kg"), 1.5);
  EXPECT_EQ(*document().number("inertia[2]"), 0.3);
  EXPECT_EQ(*document().number("rotors.r0.position_m[1]"), 2);
  EXPECT_EQ(*document().number("battery.cells"), 3);
  EXPECT_EQ(*document().number("q[1]"), 0.25);  // the key itself ends in [1]
  EXPECT_EQ(*document().number("drag"), std::nullopt);
  EXPECT_EQ(*document().number("flight.start.tilt_deg"), std::nullopt);
}

TEST(TomlDocument, RefusesAPathToSomethingElse) {
  const auto error = [](const char* path) { return document().number(path).error().message; };
  EXPECT_THAT(error("name"), HasSubstr("`name` is no number"));
  EXPECT_THAT(error("inertia[3]"), HasSubstr("`inertia` has 3 elements"));
  EXPECT_THAT(error("mass_kg[0]"), HasSubstr("`mass_kg` is no array"));
  EXPECT_THAT(error("mass_kg.x"), HasSubstr("`mass_kg` is no table"));
}

TEST(TomlDocument, ReplacesAndAddsNumbers) {
  const auto changed = document().with(
      {{"mass_kg", 1.625}, {"inertia[1]", 0.5}, {"q[1]", 0.75}, {"flight.start.tilt_deg", -12.5}});
  ASSERT_TRUE(changed) << changed.error().to_string();
  EXPECT_EQ(number_in(*changed, "mass_kg"), 1.625);
  EXPECT_EQ(number_in(*changed, "inertia[0]"), 0.1);
  EXPECT_EQ(number_in(*changed, "inertia[1]"), 0.5);
  EXPECT_EQ(number_in(*changed, "q[1]"), 0.75);
  EXPECT_EQ(number_in(*changed, "flight.start.tilt_deg"), -12.5);
  EXPECT_THAT(*changed, HasSubstr("'iris'"));
}

TEST(TomlDocument, WritesWholeNumbersAsIntegers) {
  const auto changed = document().with({{"battery.cells", 4.0}});
  const auto file = TomlFile::parse(*changed, "new.toml");
  EXPECT_EQ(file->root().table("battery").integer("cells"), 4);
}

// The order of metrics is that of their columns, and the order of rotors is that of the mixer.
TEST(TomlDocument, KeepsTheOrderOfTheKeys) {
  const auto changed = TomlDocument::parse(
                           "[metrics.tilts]\nmax = 1\n[metrics.'a b']\nmax = 2\n[rotors]\n"
                           "right = { x = [1, 2], y = 3 }\nleft = { x = [3, 4] }\n"
                           "[more]\nof = { z = { k = 1 }, y = { k = 2 } }\nlast = 1\nfirst = 2\n",
                           "a.toml")
                           ->with({{"rotors.right.x[0]", 5},
                                   {"metrics.tilts.max", 1.5},
                                   {"more.last", 4},
                                   {"more.added", 7},
                                   {"a.new", 1}});
  ASSERT_TRUE(changed) << changed.error().to_string();
  const auto file = TomlFile::parse(*changed, "new.toml");
  ASSERT_TRUE(file) << file.error().to_string();
  const TomlTable root = file->root();
  EXPECT_THAT(root.keys(), ElementsAre("metrics", "rotors", "more", "a"));
  EXPECT_THAT(root.table("metrics").keys(), ElementsAre("tilts", "a b"));
  EXPECT_THAT(root.table("rotors").keys(), ElementsAre("right", "left"));
  EXPECT_THAT(root.table("more").table("of").keys(), ElementsAre("z", "y"));
  EXPECT_THAT(root.table("more").keys(), ElementsAre("last", "first", "added", "of"));
  EXPECT_EQ(number_in(*changed, "rotors.right.x[0]"), 5);
  EXPECT_EQ(number_in(*changed, "metrics.tilts.max"), 1.5);
}

RC_GTEST_PROP(TomlDocument, KeepsEveryBitOfANumber, ()) {
  const double value = *rc::gen::oneOf(rc::gen::arbitrary<double>(), rc::gen::element(0.0, -0.0));
  const auto changed = document().with({{"mass_kg", value}});
  RC_ASSERT(changed.has_value());
  const double read = number_in(*changed, "mass_kg");
  RC_ASSERT(read == value && std::signbit(read) == std::signbit(value));
}

}  // namespace
}  // namespace attest
