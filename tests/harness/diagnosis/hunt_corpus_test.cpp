#include "harness/diagnosis/hunt_corpus.hpp"

#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

const char* const of_corpus = "px4-v1.16.0";
const std::vector<ModuleUnderTest> corpus_subjects = {{of_corpus, Module::rate_unit}};

std::string case_text(double rate, const std::string& why = "a test", const char* more = "") {
  return fmt::format(
      "schema = 1\nprofiles = [\"{}\"]\ngroup = \"hunt\"\nmodule = \"rate_unit\"\nwhy = \"{}\"\n"
      "rates_hz = [1000]\nrates_why = \"a test\"\nduration_ticks = 20\n{}"
      "[vehicle_angular_velocity]\n\"xyz[0]\" = {}\n",
      of_corpus, why, more, rate);
}

class HuntCorpusTest : public testing::Test {
 protected:
  HuntCorpus open(Level level = Level::numeric) const {
    auto corpus = HuntCorpus::open(folder_, corpus_subjects, level);
    EXPECT_TRUE(corpus) << corpus.error().to_string();
    return *std::move(corpus);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      if (entry.is_regular_file()) found.push_back(entry.path());
    }
    return found;
  }
  fs::path write(const std::string& name, const std::string& text) const {
    const fs::path file = folder_ / name;
    fs::create_directories(file.parent_path());
    EXPECT_TRUE(write_file(file, text));
    return file;
  }

  TemporaryDirectory directory_;
  const fs::path folder_ = directory_.path() / "cases";
};

TEST_F(HuntCorpusTest, TheSameInputsAreOneFile) {
  HuntCorpus corpus = open();
  EXPECT_TRUE(corpus.inputs().empty());
  for (const char* why : {"one reason", "another reason"}) {
    ASSERT_TRUE(corpus.add(of_corpus, case_text(0.5, why)));
  }
  EXPECT_EQ(corpus.added(), 1u);
  ASSERT_EQ(files().size(), 1u);
  EXPECT_THAT(files()[0].filename().string(), testing::StartsWith("rate_unit_"));
  ASSERT_TRUE(corpus.add(of_corpus, case_text(0.25)));
  EXPECT_EQ(files().size(), 2u);
  const HuntCorpus again = open();
  EXPECT_EQ(again.used(), 2u);
  ASSERT_EQ(again.inputs().size(), 2u);
  EXPECT_EQ(again.inputs()[0].subject.module, Module::rate_unit);
  EXPECT_EQ(again.inputs()[0].rate, Rate::hz(1000));
}

TEST_F(HuntCorpusTest, NeverHasMoreThanItsLimit) {
  HuntCorpus corpus = open();
  for (std::size_t i = 0; i < most_of_corpus - 1; ++i) {
    ASSERT_TRUE(corpus.add(of_corpus, case_text(static_cast<double>(i))));
  }
  HuntCorpus later = open();  // counts what is there
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(later.add(of_corpus, case_text(1000 + i)));
  EXPECT_EQ(files().size(), most_of_corpus);
  EXPECT_EQ(later.added(), 1u);
  EXPECT_EQ(later.left_out(), 2u);
}

TEST_F(HuntCorpusTest, WhatIsNotHuntedIsSkippedWithItsNumber) {
  write("px4-v1.16.0/hunt/one.toml", case_text(1));
  write("px4-v1.16.0/hunt/exact.toml", case_text(2, "a test", "level = \"exact\"\n"));
  std::string other = case_text(3);
  other.replace(other.find("px4-v1.16.0"), 11, "px4-v1.15.4");
  write("px4-v1.15.4/hunt/one.toml", other);
  write("px4-v1.15.4/hunt/two.toml", other);
  const HuntCorpus corpus = open();
  EXPECT_EQ(corpus.used(), 1u);
  EXPECT_THAT(corpus.skipped(), ElementsAre(Pair("for the level exact only", 1u),
                                            Pair("of a profile or module that is not hunted", 2u)));
  EXPECT_EQ(open(Level::exact).used(), 2u);
}

TEST_F(HuntCorpusTest, AFileThatIsNotACaseIsAnError) {
  write("VERSION", "1");                                 // of the suite
  write("px4-v1.16.0/hunt/.one.toml.x1y2z3", "schema");  // left by a process that was killed
  EXPECT_TRUE(HuntCorpus::open(folder_, corpus_subjects, Level::numeric));
  const fs::path note = write("px4-v1.16.0/hunt/notes.txt", "mine");
  const auto corpus = HuntCorpus::open(folder_, corpus_subjects, Level::numeric);
  ASSERT_FALSE(corpus);
  EXPECT_EQ(corpus.error().to_string(),
            note.string() +
                ": is not a case, and a corpus has only cases; remove it, or name "
                "another folder");
  fs::remove(note);
  const fs::path wrong = write("px4-v1.16.0/hunt/wrong.toml", "schema = 1\nwho = 3\n");
  const auto error = HuntCorpus::open(folder_, corpus_subjects, Level::numeric).error().to_string();
  EXPECT_THAT(error, HasSubstr(wrong.string() + ":2"));
  EXPECT_THAT(error, HasSubstr("correct or remove it, or name another folder"));
}

}  // namespace
}  // namespace attest
