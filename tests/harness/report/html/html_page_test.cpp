#include <bit>
#include <cstdint>
#include <limits>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/report/document.hpp"
#include "harness/report/html/plot_data.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

nlohmann::json data_of(Plot plot) {
  Document page;
  page.groups = {{"", "time [s]", {std::move(plot)}}};
  return nlohmann::json::parse(plot_data_json(page)).at("groups")[0].at("plots")[0];
}

std::vector<float> floats_of(const std::string& text) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<float> numbers;
  std::uint64_t bits = 0;
  int count = 0;
  for (std::size_t i = 0; i < text.size() && text[i] != '='; ++i) {
    for (int bit = 5; bit >= 0; --bit) {  // bytes come first to last, their bits highest first
      const std::uint64_t one = (digits.find(text[i]) >> bit) & 1u;
      bits |= one << (8 * (count / 8) + 7 - count % 8);
      if (++count < 32) continue;
      numbers.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      bits = 0;
      count = 0;
    }
  }
  return numbers;
}

TEST(PlotData, SeriesWithEqualTimesShareThem) {
  Plot plot{"Rates", "rad/s", ""};
  plot.series = {{"a", {0, 1}, {5, 6}}, {"b", {0, 1}, {7, 8}}, {"c", {0, 0.5}, {9, 9}}};
  const auto data = data_of(plot);
  ASSERT_EQ(data.at("grids").size(), 2u);
  EXPECT_EQ(data.at("grids")[1], base64(std::vector<float>{0, 0.5f}));
  EXPECT_EQ(data.at("series")[1].at("grid"), 0);
  EXPECT_EQ(data.at("series")[2].at("grid"), 1);
  EXPECT_EQ(data.at("series")[1].at("y"), base64(std::vector<float>{7, 8}));
}

TEST(PlotData, ALongSeriesKeepsItsSpikeAndTheMarkedPoint) {
  PlotSeries series{"long", {}, {}};
  for (int i = 0; i < 100'000; ++i) {
    series.x.push_back(i);
    series.y.push_back(i == 54'321 ? 1e6f : 0);
  }
  Plot plot{"Long", "", ""};
  plot.series = {series};
  plot.marks = {{77'777, "first"}};
  const auto data = data_of(plot);
  const std::vector<float> x = floats_of(data.at("grids")[0]);
  const std::vector<float> y = floats_of(data.at("series")[0].at("y"));
  ASSERT_EQ(x.size(), y.size());
  EXPECT_LE(x.size(), 2010u);
  EXPECT_THAT(x, IsSupersetOf({0.0f, 54'321.0f, 77'776.0f, 77'777.0f, 77'778.0f, 99'999.0f}));
  EXPECT_THAT(y, Contains(1e6f).Times(1));
}

TEST(PlotData, ABandHasItsOwnTimes) {
  Plot plot{"Rates", "rad/s", ""};
  plot.series = {{"got", {0, 1}, {5, 6}}};
  plot.band = PlotBand{"tolerance", {0, 2}, {4, 5}, {6, 7}};
  plot.shape = PlotShape::steps;
  const auto data = data_of(plot);
  EXPECT_EQ(data.at("band").at("grid"), 1);
  EXPECT_EQ(data.at("band").at("high"), base64(std::vector<float>{6, 7}));
  EXPECT_EQ(data.at("shape"), "steps");
}

TEST(PlotData, ABoundHasItsPlaceAndSide) {
  Plot plot{"Rates", "rad/s", ""};
  plot.series = {{"got", {0, 1}, {5, 6}}};
  plot.bounds = {{0.5, 1, 7, "turns: <9", true, true}, {0, 1, -7, "", false}};
  const auto bounds = data_of(plot).at("bounds");
  ASSERT_EQ(bounds.size(), 2u);
  const nlohmann::json first = {{"first", 0.5},        {"last", 1.0},   {"level", 7.0},
                                {"text", "turns: <9"}, {"upper", true}, {"missed", true}};
  EXPECT_EQ(bounds[0], first);
  EXPECT_EQ(bounds[1].at("upper"), false);
}

TEST(HtmlPage, TablesAlignNumbersAndMarkVerdicts) {
  Document page;
  page.head = {Conclusion::fail, "a and b", ""};
  page.tables = {{"Signals", {"signal", "worst", "note"}, {}}};
  page.tables[0].rows = {{"roll", "-0.5", {"late", Verdict::fail}}, {"pitch", "", "5 is a text?"}};
  page.tables[0].rows.push_back({"yaw", "2", "none"});
  const std::string text = html_page(page);
  EXPECT_THAT(text, HasSubstr("<td class=\"number\">-0.5</td>"));
  EXPECT_THAT(text, HasSubstr("<td class=\"v-fail\"><b>\u2717</b> late</td>"));
  EXPECT_THAT(text, HasSubstr("<td class=\"\">5 is a text?</td>"));
  EXPECT_THAT(text, HasSubstr("<th scope=\"row\" class=\"\">roll</th>"));
  EXPECT_THAT(text, HasSubstr("conclusion fail"));
}

TEST(HtmlPage, ATableWithoutColumnsIsAHeadingAndLines) {
  Document page;
  page.head = {Conclusion::pass, "two logs"};
  page.tables = {{"a.ulg", {}}};
  page.tables[0].below = {"first at tick 3", "  got   1"};
  const std::string text = html_page(page);
  EXPECT_THAT(text, HasSubstr("<h3>a.ulg</h3>"));
  EXPECT_THAT(text, Not(HasSubstr("<caption>a.ulg")));
  EXPECT_THAT(text, HasSubstr("<code>  got   1</code>"));  // aligned as in the terminal
}

TEST(HtmlPage, AllTextsAreEscaped) {
  const std::string evil = "<img src=x></script>\x1b{{title}}";
  Document page;
  page.head = {Verdict::pass, evil, evil};
  page.notes = {{evil, true}};
  page.facts = {{evil, evil}, {"empty", ""}};
  page.tables = {{evil, {evil}, {{evil, {evil, Verdict::pass, evil}}}}};
  Plot plot{evil, evil, evil};
  plot.series = {{evil, {0}, {std::numeric_limits<float>::quiet_NaN()}}};
  plot.marks = {{0, evil}};
  page.groups = {{evil, evil, {plot}}};
  const std::string text = html_page(page);
  EXPECT_THAT(text, Not(HasSubstr("<img")));
  EXPECT_THAT(text, Not(HasSubstr("x></script>")));
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  EXPECT_THAT(text, Not(HasSubstr("<dt>empty</dt>")));
}

}  // namespace
}  // namespace attest
