#include "harness/verify/recorded_check.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::HasSubstr;

namespace fs = std::filesystem;

const fs::path recorded = ATTEST_SOURCE_DIR "/golden/recorded";

class RecordedCheckTest : public testing::Test {
 protected:
  fs::path folder() const { return directory_.path() / "recorded"; }

  // A copy of one recording with some text in it replaced.
  void copy(const fs::path& trace, const std::string& from = "", const std::string& to = "") {
    fs::create_directories(folder());
    const fs::path source = recorded / trace;
    std::string text = *read_file(source);
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    std::ofstream(folder() / source.filename(), std::ios::binary) << text;
    std::string provenance = *read_file(source.parent_path() / "provenance.toml");
    const std::string was = *sha256_of_file(source);
    provenance.replace(provenance.find(was), was.size(), sha256(text));
    std::ofstream(folder() / "provenance.toml", std::ios::binary) << provenance;
  }

  std::string error() const {
    const auto check = check_recorded(folder());
    EXPECT_FALSE(check);
    return check ? "" : check.error().to_string();
  }

 private:
  TemporaryDirectory directory_;
};

TEST(RecordedCheck, TheReferenceIsTheFirmware) {
  const auto check = check_recorded(recorded);
  ASSERT_TRUE(check) << check.error().to_string();
  EXPECT_EQ(check->conforming, check->traces);
  EXPECT_GE(check->traces, 17u);
  EXPECT_EQ(check->first_difference, "");
}

TEST_F(RecordedCheckTest, ADifferenceIsNamed) {
  copy("mixer-v1.5.5/4x.csv", "-0.60356307", "-0.60356302");
  const auto check = check_recorded(folder());
  ASSERT_TRUE(check) << check.error().to_string();
  EXPECT_EQ(check->traces, 1u);
  EXPECT_EQ(check->conforming, 0u);
  EXPECT_THAT(check->first_difference,
              AllOf(HasSubstr("4x.csv: "), HasSubstr("output[1] at tick 0")));
}

TEST_F(RecordedCheckTest, EditedBytesAreAnError) {
  copy("mixer-v1.5.5/4x.csv");
  std::ofstream(folder() / "4x.csv", std::ios::app) << "\n";
  EXPECT_THAT(error(), AllOf(HasSubstr("4x.csv"), HasSubstr("is not what was recorded")));
}

TEST_F(RecordedCheckTest, ATraceThatIsNotListedIsAnError) {
  copy("mixer-v1.5.5/4x.csv");
  fs::copy(folder() / "4x.csv", folder() / "4y.csv");
  EXPECT_THAT(error(), AllOf(HasSubstr("4y.csv"), HasSubstr("is not listed")));
}

TEST_F(RecordedCheckTest, NoTracesAreAnError) {
  EXPECT_THAT(error(), HasSubstr("no recorded traces"));
  fs::create_directories(folder());
  EXPECT_THAT(error(), HasSubstr("no recorded traces"));
}

}  // namespace
}  // namespace attest
