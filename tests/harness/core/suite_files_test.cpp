#include "harness/core/suite_files.hpp"

#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class SuiteFiles : public testing::Test {
 protected:
  SuiteFiles() {
    for (const auto& [name, bytes] : files_) {
      fs::create_directories((root_ / name).parent_path());
      write_file(root_ / name, bytes);
    }
  }

  const std::map<std::string, std::string> files_{{"cases/law/b.toml", "b = 1\n"},
                                                  {"cases/law-2/a.toml", "a = 1\n"},
                                                  {"cases/README.md", std::string(100000, 'r')},
                                                  {"cases/EMPTY", ""}};
  const TemporaryDirectory directory_;
  const fs::path root_ = directory_.path() / "suite";
};

TEST_F(SuiteFiles, AreFoundInTheOrderOfTheirBytes) {
  const fs::path cases = root_ / "cases";
  EXPECT_THAT(*suite_files_below(cases), ElementsAre(cases / "EMPTY", cases / "README.md",
                                                     cases / "law-2/a.toml", cases / "law/b.toml"));
  EXPECT_THAT(*suite_folders_in(cases), ElementsAre(cases / "law", cases / "law-2"));
  EXPECT_EQ(suite_files_below(root_ / "golden").error().to_string(),
            (root_ / "golden").string() + ": cannot be read: No such file or directory");
  EXPECT_FALSE(suite_folders_in(root_ / "golden"));
}

TEST_F(SuiteFiles, AreReadAndCopied) {
  ASSERT_TRUE(copy_suite_files(root_, directory_.path() / "copy"));
  for (const auto& [name, bytes] : files_) {
    EXPECT_EQ(read_suite_file(root_ / name), bytes) << name;
    EXPECT_EQ(read_file(directory_.path() / "copy" / name), bytes) << name;
  }
  EXPECT_FALSE(read_suite_file(root_ / "cases"));
}

TEST_F(SuiteFiles, AreOtherThanFolders) {
  EXPECT_TRUE(is_suite_folder(root_ / "cases"));
  EXPECT_FALSE(is_suite_file(root_ / "cases"));
  EXPECT_TRUE(is_suite_file(root_ / "cases/law/b.toml"));
  EXPECT_FALSE(is_suite_folder(root_ / "cases/law/b.toml"));
  EXPECT_FALSE(is_suite_file(root_ / "cases/law/c.toml"));
  EXPECT_FALSE(is_suite_folder(root_ / "golden"));
}

}  // namespace
}  // namespace attest
