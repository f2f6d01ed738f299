// The signals of hostile logs: names that collide, topics without timestamp, extreme times.
#include "harness/compare/timed_signals.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "harness/compare/compare_signals.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/ulog/crafted.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using ulog::Crafted;
using ulog::raw;

constexpr auto latest = static_cast<std::uint64_t>(latest_us);

class TimedSignalsOfLog : public testing::Test {
 protected:
  TimedSignals read(const Crafted& log) {
    auto signals = signals_of_log(directory_.write("a.ulg", log.bytes()));
    EXPECT_TRUE(signals) << signals.error().message;
    return signals ? *std::move(signals) : TimedSignals{};
  }

  static std::vector<float> values(const TimedSignals& signals, const std::string& name) {
    const TimedSignal* const signal = signals.find(name);
    return signal != nullptr ? signal->values : std::vector<float>();
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(TimedSignalsOfLog, ATopicMayHaveTheNameOfAnInstanceOfAnother) {
  Crafted log;
  log.flag_bits()
      .format("pose:uint64_t timestamp;float x;")
      .format("pose[1]:uint64_t timestamp;float[100] y;float x;")
      .subscribe(0, "pose[1]")
      .subscribe(1, "pose", 1)
      .data(0, raw(std::uint64_t{1}) + std::string(404, '\0'))
      .data(1, raw(std::uint64_t{2}, 7.0f));
  const TimedSignals signals = read(log);
  EXPECT_THAT(values(signals, "pose[1].x"), ElementsAre(7));
  EXPECT_THAT(values(signals, "pose[1].y[99]"), ElementsAre(0));
  EXPECT_THAT(signals.notes, ElementsAre("1 signal left out, because another one has the same "
                                         "name; the first: pose[1].x"));
}

TEST_F(TimedSignalsOfLog, RepeatedFieldsAreCounted) {
  Crafted log;
  log.flag_bits()
      .format("pose:uint64_t timestamp;float x;float x;float x;")
      .subscribe(0, "pose")
      .data(0, raw(std::uint64_t{1}, 1.0f, 2.0f, 3.0f));
  const TimedSignals signals = read(log);
  EXPECT_THAT(values(signals, "pose.x"), ElementsAre(1));
  EXPECT_THAT(signals.notes, Contains(HasSubstr("pose has the field x more than once")));
  EXPECT_THAT(signals.notes, Contains(HasSubstr("2 signals left out")));
}

TEST_F(TimedSignalsOfLog, ATopicWithoutTimestampIsCounted) {
  Crafted log;
  log.flag_bits().format("a:uint64_t timestamp;float x;").format("b:float x;");
  log.format("c:uint64_t[2] timestamp;float x;");
  log.subscribe(0, "a").subscribe(1, "b").subscribe(2, "c");
  log.data(0, raw(std::uint64_t{1}, 1.0f)).data(1, raw(1.0f)).data(1, raw(2.0f));
  log.data(2, raw(std::uint64_t{1}, std::uint64_t{2}, 1.0f));
  const TimedSignals signals = read(log);
  EXPECT_EQ(signals.all.size(), 1u);
  EXPECT_THAT(
      signals.notes,
      ElementsAre("3 samples of 2 topics left out, because the topic has no timestamp: 2 of b, "
                  "1 of c"));
}

TEST_F(TimedSignalsOfLog, ExtremeTimesAreCountedAndNeverOverflow) {
  Crafted log;
  log.flag_bits().format("a:uint64_t timestamp;float x;").subscribe(0, "a");
  for (const std::uint64_t time :
       {std::uint64_t{0}, latest, latest + 1, std::numeric_limits<std::uint64_t>::max()}) {
    log.data(0, raw(time, 1.0f));
  }
  const TimedSignals signals = read(log);
  EXPECT_THAT(signals.find("a.x")->times_us, ElementsAre(0, latest));
  EXPECT_THAT(signals.notes, ElementsAre(HasSubstr("2 samples of a left out, because the time is "
                                                   "beyond")));
  for (const std::int64_t shift : {-latest_us, latest_us}) {
    const auto found = compare_signals(signals, signals, Tolerances(), 0, shift);
    EXPECT_EQ(found.compared(), 1u);
  }
}

TEST(EstimateShift, APeriodOfAnyLengthIsNoOverflow) {
  TimedSignal got{"x", {}, {}}, want{"x", {}, {}};
  for (std::int64_t i = 0; i < 20; ++i) {
    got.times_us.push_back(static_cast<std::uint64_t>(i * (latest_us / 20)));
    got.values.push_back(static_cast<float>(i));
    want.values.push_back(1);
  }
  want.times_us = got.times_us;
  EXPECT_FALSE(estimate_shift({"a", {got}, {}}, {"b", {want}, {}}));
}

TEST(TimedSignals, RowsOfCsvWithExtremeTimesAreCounted) {
  TemporaryDirectory directory;
  const auto read =
      signals_of_csv(directory.write("a.csv", "timestamp,x\n1,2\n18446744073709551615,3\n"));
  ASSERT_TRUE(read);
  EXPECT_THAT(read->all[0].values, ElementsAre(2));
  EXPECT_THAT(read->notes, ElementsAre(HasSubstr("1 row left out, because the time is beyond")));
}

}  // namespace
}  // namespace attest
