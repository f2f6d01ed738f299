// The words of docs/verdicts.md, of the schemas and of the style of pages are those of the code.
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/sweep/summary.hpp"
#include "harness/verify/claim.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {
namespace {

using testing::ElementsAreArray;
using testing::UnorderedElementsAreArray;
using Words = std::vector<std::string>;

const std::filesystem::path source = ATTEST_SOURCE_DIR;

std::string text_of_file(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_FALSE(text.str().empty()) << file;
  return text.str();
}

// The words of an enumeration whose last value is `last`.
template <typename Enum>
Words words_up_to(Enum last) {
  Words words;
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    words.emplace_back(name_of(static_cast<Enum>(i)));
  }
  return words;
}

const Words verdicts = words_up_to(Verdict::xpass);
const Words conclusions = words_up_to(Conclusion::stopped);
const Words rows = words_up_to(RowVerdict::not_judged);
const Words standings = {
    std::string(name_of(Standing::conformant)), std::string(name_of(Standing::events_agree)),
    std::string(name_of(Standing::partial)), std::string(name_of(Standing::none))};

// The first cells of the table whose header begins with `heading`, without their backticks.
Words first_column(const std::string& text, const std::string& heading) {
  Words cells;
  std::istringstream lines(text.substr(text.find("\n| " + heading + " |") + 1));
  std::string line;
  std::getline(lines, line);  // the header
  std::getline(lines, line);  // the line below it
  while (std::getline(lines, line) && line.starts_with("| `")) {
    cells.push_back(line.substr(3, line.find('`', 3) - 3));
  }
  return cells;
}

TEST(WordsOfReports, AreExplainedInTheDocument) {
  const std::string text = text_of_file(source / "docs/verdicts.md");
  EXPECT_THAT(first_column(text, "verdict"), UnorderedElementsAreArray(verdicts));
  EXPECT_THAT(first_column(text, "conclusion"), ElementsAreArray(conclusions));
  EXPECT_THAT(first_column(text, "standing"), ElementsAreArray(standings));
  EXPECT_THAT(first_column(text, "row"), ElementsAreArray(rows));
  for (const auto decision :
       {RequirementDecision::met, RequirementDecision::not_met, RequirementDecision::undecided}) {
    EXPECT_THAT(text, testing::HasSubstr(fmt::format("`{}`", name_of(decision))));
  }
}

TEST(WordsOfReports, TheDocumentSaysWhichVerdictsFailARun) {
  const std::string text = text_of_file(source / "docs/verdicts.md");
  for (const std::string& word : verdicts) {
    std::smatch row;
    ASSERT_TRUE(std::regex_search(text, row, std::regex("\n\\| `" + word + "` \\|.*\\|(.*)\\|\n")));
    EXPECT_EQ(row[1].str() == " yes ", fails_a_run(*parse_verdict(word))) << word;
  }
}

TEST(WordsOfReports, AreThoseOfTheSchemas) {
  const auto report =
      nlohmann::json::parse(text_of_file(source / "harness/report/report.schema.json"));
  EXPECT_THAT(report["properties"]["totals"]["required"].get<Words>(), ElementsAreArray(verdicts));
  EXPECT_THAT(report["properties"]["standing"]["enum"].get<Words>(), ElementsAreArray(standings));
  EXPECT_THAT(report["definitions"]["verdict"]["enum"].get<Words>(),
              UnorderedElementsAreArray(verdicts));
  const auto stress =
      nlohmann::json::parse(text_of_file(source / "harness/report/stress.schema.json"));
  Words judged = conclusions;
  // Stress always has a budget, and what it did not reach makes it `partial`.
  std::erase(judged, name_of(Conclusion::measured));
  std::erase(judged, name_of(Conclusion::stopped));
  EXPECT_THAT(stress["properties"]["verdict"]["enum"].get<Words>(),
              UnorderedElementsAreArray(judged));
}

// All that `pattern` captures in the text.
std::set<std::string> captured(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator one(text.begin(), text.end(), regex), end; one != end; ++one) {
    found.insert((*one)[1].str());
  }
  return found;
}

TEST(WordsOfReports, HaveAColourInPages) {
  const std::string cells = text_of_file(source / "harness/report/html/page.css");
  EXPECT_THAT(captured(cells, "td\\.v-([a-z-]+)"), UnorderedElementsAreArray(verdicts));
  EXPECT_THAT(captured(cells, "\\.conclusion\\.([a-zA-Z-]+)"),
              UnorderedElementsAreArray({"pass", "fail"}));
}

// "the verdict is `crash`", "the verdict `skip`", "a verdict of `protocol`".
TEST(WordsOfReports, DocumentsUseNoOtherVerdicts) {
  std::vector<std::filesystem::path> documents = {source / "README.md", source / "ARCHITECTURE.md"};
  for (const char* folder : {"docs", "harness", "golden", "cases", "controller/starters"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
      if (entry.path().extension() == ".md") documents.push_back(entry.path());
    }
  }
  std::size_t checked = 0;
  for (const std::filesystem::path& document : documents) {
    for (const std::string& word : captured(
             text_of_file(document), "verdicts?\\s(?:is\\s|are\\s|with\\s|was\\s)?`([^`]+)`")) {
      EXPECT_TRUE(parse_verdict(word)) << document << ": `" << word << "` is no verdict";
      ++checked;
    }
  }
  EXPECT_GT(checked, 10u);
}

}  // namespace
}  // namespace attest
