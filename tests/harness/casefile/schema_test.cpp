// SCHEMA.md contains every word that a case file may use, and its example is a valid case.
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/flight_mode.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/core/file.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

const fs::path source = ATTEST_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  const auto text = read_file(path);
  if (!text) ADD_FAILURE() << text.error().to_string();
  return text.value_or("");
}

const std::string& schema() {
  static const std::string text = text_of(source / "harness/casefile/SCHEMA.md");
  return text;
}

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) {
    found.insert((*it)[1]);
  }
  return found;
}

// Whether the word occurs between backquotes.
bool is_named(const std::string& word) {
  static const std::set<std::string> words = [] {
    std::string code;
    for (const std::string& quoted : matches(schema(), "`([^`\n]+)`")) code += quoted + " ";
    return matches(code, "([A-Za-z_0-9]+)");
  }();
  return words.contains(word);
}

std::string parsers() {
  std::string text;
  for (const char* name : {"parse.cpp", "parse_flight.cpp", "parse_profiles.cpp",
                           "parse_signal.cpp", "parse_topic.cpp", "task_set.cpp"}) {
    text += text_of(source / "harness/casefile" / name);
  }
  return text;
}

// Keys and values are the quoted words, except the stems of times, which take a unit.
TEST(Schema, NamesEveryWordThatTheParserReads) {
  const std::string text = parsers();
  const auto stems = matches(text, R"re(_spans?\(\w+, "([a-z_]+)"\))re");
  const auto words = matches(text, R"re("([a-z][a-z_]+)")re");
  EXPECT_GE(stems.size(), 8u);
  EXPECT_GE(words.size(), 60u);
  for (const std::string& word : words) {
    if (stems.contains(word)) continue;
    EXPECT_TRUE(is_named(word)) << word;
  }
  for (const std::string& stem : stems) {
    EXPECT_TRUE(is_named(stem + "_ticks")) << stem;
    EXPECT_TRUE(is_named(stem + "_s")) << stem;
  }
}

TEST(Schema, NamesEveryTopicFieldAndFlightMode) {
  for (const Channel& channel : channels()) {
    if (!channel.name.starts_with("in/") || channel.type == ChannelType::bit) continue;
    const std::string name(channel.name.substr(3));
    const auto dot = name.find('.');
    const std::string field = name.substr(dot + 1);
    EXPECT_TRUE(is_named(name.substr(0, dot))) << name;
    EXPECT_TRUE(is_named(field.substr(0, field.find('[')))) << name;
  }
  for (const Module module : {Module::mc_att_control, Module::attitude_unit}) {
    for (const FlightMode& mode : flight_modes(module)) {
      EXPECT_TRUE(is_named(std::string(mode.name))) << mode.name;
    }
  }
}

TEST(Schema, NamesEveryKeyOfTheCases) {
  const auto files = find_case_files({source / "cases"});
  ASSERT_TRUE(files) << files.error().to_string();
  for (const fs::path& file : *files) {
    for (const std::string& key : matches(text_of(file), R"re((?:^|\n|[{,] *)([a-z_]+) *=)re")) {
      EXPECT_TRUE(is_named(key)) << file << ": " << key;
    }
  }
}

TEST(Schema, NamesEveryStandardRate) {
  std::string rates;
  for (const Rate& rate : standard_rates()) rates += rate.to_string() + ", ";
  rates.resize(rates.size() - 2);
  rates.replace(rates.rfind(", "), 2, " and ");
  EXPECT_THAT(schema(), testing::HasSubstr(rates + " Hz"));
}

// Each flight mode has the flags of its row.
TEST(Schema, FlightModesHaveTheirFlags) {
  for (const Module module : {Module::mc_att_control, Module::attitude_unit}) {
    for (const FlightMode& mode : flight_modes(module)) {
      std::string cells;
      for (const std::uint8_t flag : mode.flags) cells += " " + std::to_string(flag) + " \\|";
      const std::regex row("\\|[^|\n]*`" + std::string(mode.name) + "`[^|\n]*\\|" + cells);
      EXPECT_TRUE(std::regex_search(schema(), row)) << mode.name;
    }
  }
}

TEST(Schema, TheExampleIsACase) {
  const std::string begin = "```toml\n";
  const auto from = schema().find(begin) + begin.size();
  const std::string example = schema().substr(from, schema().find("```", from) - from);
  const CaseFiles files;
  const auto parsed = parse_case(files.write("attitude", "example", example));
  ASSERT_TRUE(parsed) << parsed.error().to_string();
  EXPECT_EQ(stimulate(*parsed, Rate::hz(250)).samples.size(), 58u);
}

}  // namespace
}  // namespace attest
