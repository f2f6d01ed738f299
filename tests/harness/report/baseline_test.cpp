#include "tests/harness/report/baseline.hpp"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class Baseline : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "a.txt") << "one\ntwo\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string content(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_;
};

TEST_F(Baseline, SaysNothingWhenEqual) {
  EXPECT_THAT(baseline_complaint(folder_, "a.txt", "one\ntwo\n", false), IsEmpty());
  EXPECT_THAT(baseline_complaint(folder_, "a.txt", "one\ntwo\n", true), IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.txt.new"));
}

TEST_F(Baseline, ShowsTheFirstLineThatDiffers) {
  const std::string complaint = baseline_complaint(folder_, "a.txt", "one\ntoo\n", false);
  EXPECT_THAT(complaint, HasSubstr("line 2\n  baseline: two\n  now:      too\n"));
  EXPECT_THAT(complaint, HasSubstr("ATTEST_ACCEPT_BASELINES=1"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.txt.new"));
}

TEST_F(Baseline, AMissingLastNewlineIsADifference) {
  EXPECT_THAT(baseline_complaint(folder_, "a.txt", "one\ntwo", false), HasSubstr("line 2"));
}

TEST_F(Baseline, AcceptingWritesAFileAndStillFails) {
  const std::string complaint = baseline_complaint(folder_, "a.txt", "new\n", true);
  EXPECT_THAT(complaint, HasSubstr("diff -u "));
  EXPECT_EQ(content("a.txt"), "one\ntwo\n");
  EXPECT_EQ(content("a.txt.new"), "new\n");
}

TEST_F(Baseline, AMissingBaselineNeverAgrees) {
  EXPECT_THAT(baseline_complaint(folder_, "b.txt", "", false), HasSubstr("b.txt is not"));
}

}  // namespace
}  // namespace attest
