#include "harness/report/progress.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class ProgressTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_NE(stream_, nullptr); }
  void TearDown() override { std::fclose(stream_); }

  Progress::Options visible(int width = 120) const {
    return {stream_, Progress::Form::drawn, width};
  }

  std::string written() const {
    std::string out;
    std::rewind(stream_);
    for (int c = std::fgetc(stream_); c != EOF; c = std::fgetc(stream_)) {
      out += static_cast<char>(c);
    }
    return out;
  }

  std::FILE* stream_ = std::tmpfile();
  Progress::Clock::time_point start_{std::chrono::seconds(1)};
  VectorResult result_ = passed("attitude", "roll_30", Rate::hz(250));
};

TEST_F(ProgressTest, IsSilentUnlessVisible) {
  {
    Progress progress(2, {stream_, Progress::Form::none, 80});
    progress.add(result_);
  }
  EXPECT_EQ(written(), "");
}

TEST_F(ProgressTest, DrawsOneLineAndErasesIt) {
  {
    Progress progress(4, visible());
    progress.add(result_, start_);
  }
  EXPECT_EQ(written(),
            "\r\x1b[K[######------------------] 1/4  px4-v1.5.5/attitude/roll_30@250hz\r\x1b[K");
}

TEST_F(ProgressTest, CountsEveryResultButDrawsAtMostTwentyTimesASecond) {
  {
    Progress progress(1000, visible());
    for (int ms = 0; ms < 1000; ++ms) progress.add(result_, start_ + milliseconds(ms));
  }
  const std::string text = written();
  const auto drawn = std::count(text.begin(), text.end(), '[') / 2;  // one in the erase code
  EXPECT_EQ(drawn, 20);
  EXPECT_THAT(text, HasSubstr(" 951/1000, "));
}

TEST_F(ProgressTest, TellsTheSpeedAndTheRemainingTime) {
  Progress progress(1000, visible(), 400);  // 400 were done before
  for (int i = 0; i <= 10; ++i)
    progress.add(false, "sample 7", start_ + milliseconds(1000 * i + 1));
  EXPECT_THAT(written(), HasSubstr(" 411/1000, 1/s, 10 min left  sample 7"));
}

TEST_F(ProgressTest, NeverAnnouncesTheEnd) {
  Progress progress(21, visible());
  for (int i = 0; i < 20; ++i) progress.add(false, "x", start_ + milliseconds(100 * i + 1));
  EXPECT_THAT(written(), HasSubstr(" 20/21, 10/s, nearly done  x"));
}

// Flights take longer than other vectors, and are run last.
TEST_F(ProgressTest, KnowsNoRemainingTimeBeforeTheFirstFlight) {
  Progress progress(120, visible(), 0, 20);
  result_.elapsed_s = 0.1;
  auto now = start_;
  for (int i = 0; i < 100; ++i, now += milliseconds(100)) progress.add(result_, now);
  EXPECT_THAT(written(), HasSubstr(" 100/120, 10/s  "));
  EXPECT_THAT(written(), testing::Not(HasSubstr("left")));
  result_.plant_configuration.emplace();
  result_.elapsed_s = 2;
  for (int i = 0; i < 2; ++i, now += milliseconds(2000)) progress.add(result_, now);
  EXPECT_THAT(written(), HasSubstr(" 102/120, 8.42/s, 31 s left  "));
}

TEST_F(ProgressTest, CountsFailures) {
  result_.verdict = Verdict::crash;
  Progress progress(1, visible());
  progress.add(result_, start_);
  EXPECT_THAT(written(), HasSubstr(" 1/1, 1 failed  "));
}

TEST_F(ProgressTest, NeverWraps) {
  Progress progress(4, visible(20));
  progress.add(result_, start_);
  EXPECT_EQ(written(), "\r\x1b[K[######------------");
}

TEST_F(ProgressTest, SurvivesMoreResultsThanAnnounced) {
  Progress progress(0, visible());
  progress.add(result_, start_);
  EXPECT_THAT(written(), HasSubstr("[########################] 1/0 "));
}

TEST_F(ProgressTest, AFileGetsALineEvery10Seconds) {
  Progress progress(1000, {stream_, Progress::Form::lines, 80});
  for (int i = 0; i <= 25; ++i) {
    progress.add(i == 15, "latest", start_ + std::chrono::seconds(i));
  }
  EXPECT_EQ(written(),
            "attest: 11 of 1000 done, 1/s, 16 min left\n"
            "attest: 21 of 1000 done, 1 failed, 1/s, 16 min left\n");
}

TEST(ProgressOptions, QuietIsInvisible) {
  EXPECT_EQ(Progress::on_stderr(true).form, Progress::Form::none);
}

}  // namespace
}  // namespace attest
