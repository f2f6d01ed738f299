#include "harness/core/json_reader.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using nlohmann::json;
using testing::ElementsAre;

constexpr double inf = std::numeric_limits<double>::infinity();

TEST(JsonReader, ReadsEachType) {
  const json object = json::parse(
      R"({"text": "a", "texts": ["b", "c"], "count": 3, "integer": -3, "flag": true, "real": 0.5,
          "inner": {"x": 1}})");
  std::string error;
  JsonReader reader(object, error);
  EXPECT_EQ(reader.text("text"), "a");
  EXPECT_THAT(reader.texts("texts"), ElementsAre("b", "c"));
  EXPECT_EQ(reader.count("count"), 3u);
  EXPECT_EQ(reader.integer("integer"), -3);
  EXPECT_TRUE(reader.flag("flag"));
  EXPECT_EQ(reader.real("real"), 0.5);
  EXPECT_EQ(reader.object("inner").count("x"), 1u);
  EXPECT_FALSE(reader.has("y"));
  EXPECT_EQ(error, "");
}

TEST(JsonReader, NumbersThatAreNotFiniteAreTexts) {
  for (const double value : {inf, -inf, 1.5, -0.0}) {
    const json object = {{"x", json_of(value)}};
    std::string error;
    EXPECT_EQ(JsonReader(object, error).real("x"), value);
  }
  const json object = {{"x", json_of(std::nan(""))}};
  std::string error;
  EXPECT_TRUE(std::isnan(JsonReader(object, error).real("x")));
  EXPECT_EQ(error, "");
}

TEST(JsonReader, KeepsTheFirstError) {
  const json object = {{"x", "text"}, {"list", {1}}};
  std::string error;
  JsonReader reader(object, error);
  EXPECT_EQ(reader.count("x"), 0u);
  EXPECT_EQ(reader.texts("list").size(), 1u);
  EXPECT_TRUE(reader.list("x").empty());
  EXPECT_EQ(reader.text("missing"), "");
  EXPECT_EQ(error, "`x` is not a count");
  const auto error_of = [&](auto read) {
    std::string first;
    JsonReader one(object, first);
    read(one);
    return first;
  };
  EXPECT_EQ(error_of([](JsonReader& one) { one.texts("list"); }),
            "`list` is not a list of strings");
  EXPECT_EQ(error_of([](JsonReader& one) { one.flag("x"); }), "`x` is not true or false");
  EXPECT_EQ(error_of([](JsonReader& one) { one.integer("x"); }), "`x` is not an integer");
  EXPECT_EQ(error_of([](JsonReader& one) { one.real("x"); }), "`x` is not a number");
  EXPECT_EQ(error_of([](JsonReader& one) { one.object("x"); }), "`x` is not an object");
  EXPECT_EQ(error_of([](JsonReader& one) { one.text("y"); }), "`y` is missing");
}

}  // namespace
}  // namespace attest
