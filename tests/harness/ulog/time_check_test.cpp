// Which samples of a log have an absurd time. The log has two topics at 250 Hz and events.
#include "harness/ulog/time_check.hpp"

#include <map>
#include <utility>

#include <gmock/gmock.h>

#include "tests/harness/ulog/log_file.hpp"

namespace attest::ulog {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr std::uint64_t start_us = 100'000'000, period_us = 4000, second = 1'000'000;

enum Id : std::uint16_t { state, rates, event, other };
constexpr const char* names[] = {"state", "rates", "event", "other"};

std::uint64_t time_of(int tick) { return start_us + static_cast<std::uint64_t>(tick) * period_us; }

class FourTopics {
 public:
  FourTopics() {
    for (const char* name : names) log_.format(std::string(name) + ":uint64_t timestamp;");
    for (const Id id : {state, rates, event, other}) log_.subscribe(id, names[id]);
  }

  FourTopics& add(Id id, std::uint64_t time_us) {
    log_.data(id, raw(time_us));
    return *this;
  }
  // `wrong`: the bits that are wrong in the time of the state of a tick.
  FourTopics& add_ticks(int first, int end, const std::map<int, std::uint64_t>& wrong = {}) {
    for (int tick = first; tick < end; ++tick) {
      const auto found = wrong.find(tick);
      add(state, time_of(tick) ^ (found == wrong.end() ? 0 : found->second));
      add(rates, time_of(tick) + 100);
    }
    return *this;
  }
  FourTopics& damage() {
    log_.data(99, "");
    return *this;
  }
  const Crafted& log() const { return log_; }

 private:
  Crafted log_;
};

class ULogTimeCheck : public LogFile {
 protected:
  // The samples that do not fit, by their number in the file.
  std::vector<std::pair<int, TimeFit>> misfits(const FourTopics& topics) {
    Reader reader = open(topics.log());
    TimeCheck times;
    Message message;
    std::vector<std::pair<int, TimeFit>> found;
    for (int sample = 0; reader.next(message).value();) {
      if (!std::holds_alternative<Data>(message)) continue;
      const std::string before(std::get<Data>(message).bytes);
      const TimeFit fit = times.check(reader, message).value();
      EXPECT_EQ(std::get<Data>(message).bytes, before);
      if (fit != TimeFit::plausible) found.emplace_back(sample, fit);
      ++sample;
    }
    damages_ = reader.damage().total();
    return found;
  }

  std::uint64_t damages_ = 0;
};

TEST_F(ULogTimeCheck, TheTimesOfAnIntactLogFit) {
  EXPECT_THAT(misfits(FourTopics().add_ticks(0, 100)), IsEmpty());
}

TEST_F(ULogTimeCheck, AWrongBitThatMakesATimeLateIsFoundAtEachTick) {
  for (const int tick : {0, 1, 50, 98, 99}) {
    for (const int bit : {18, 20, 28, 32, 47, 63}) {
      const std::uint64_t wrong = std::uint64_t{1} << bit;
      if ((time_of(tick) & wrong) != 0) continue;  // makes it early
      EXPECT_THAT(misfits(FourTopics().add_ticks(0, 100, {{tick, wrong}})),
                  ElementsAre(Pair(2 * tick, TimeFit::too_late)))
          << tick << " " << bit;
    }
  }
}

TEST_F(ULogTimeCheck, SeveralLateTimesAreFound) {
  const std::uint64_t wrong = std::uint64_t{1} << 40;
  const auto found = misfits(FourTopics().add_ticks(
      0, 100, {{0, wrong}, {1, 2 * wrong}, {10, wrong}, {11, wrong}, {12, wrong + 5}, {60, 1}}));
  EXPECT_THAT(found, ElementsAre(Pair(0, TimeFit::too_late), Pair(2, TimeFit::too_late),
                                 Pair(20, TimeFit::too_late), Pair(22, TimeFit::too_late),
                                 Pair(24, TimeFit::too_late)));
}

TEST_F(ULogTimeCheck, ALateEventIsFound) {
  const std::uint64_t late = start_us + 100 * second;
  EXPECT_THAT(misfits(FourTopics().add_ticks(0, 50).add(event, late).add_ticks(50, 100)),
              ElementsAre(Pair(100, TimeFit::too_late)));
}

TEST_F(ULogTimeCheck, AGapOfAllTopicsFits) {
  FourTopics topics;
  topics.add_ticks(0, 50).add(event, time_of(50)).add_ticks(50'000, 50'050);
  topics.add_ticks(50'200, 50'230).add_ticks(500'000, 500'005);
  EXPECT_THAT(misfits(topics), IsEmpty());
}

TEST_F(ULogTimeCheck, ATopicThatIsOftenBehindDecidesNothing) {
  FourTopics topics;  // like sensor_preflight of 2016, which has no time
  const auto add = [&](int begin, int end) {
    for (int tick = begin; tick < end; ++tick) {
      topics.add_ticks(tick, tick + 1);
      for (int i = 0; i < 5; ++i) topics.add(event, 0).add(other, 7);
    }
  };
  add(0, 50);
  add(50'000, 50'050);
  const auto found = misfits(topics);
  EXPECT_EQ(found.size(), 8u);
  for (const auto& [sample, fit] : found) {
    EXPECT_EQ(fit, TimeFit::too_early);
    EXPECT_GE(sample % 12, 2);  // not of the ticks
  }
}

// As at the start of a log of PX4.
TEST_F(ULogTimeCheck, TheFirstSamplesOfTopicsDecideNothing) {
  FourTopics topics;
  topics.add(other, start_us - 60 * second).add(state, time_of(0)).add(event, second);
  topics.add(rates, start_us - 2 * second).add_ticks(1, 100);
  const auto found = misfits(topics);
  EXPECT_THAT(found, ElementsAre(Pair(0, TimeFit::too_early), Pair(2, TimeFit::too_early),
                                 Pair(3, TimeFit::too_early)));
}

TEST_F(ULogTimeCheck, AFirstTimeThatIsFarBeforeTheOthersIsFound) {
  for (const std::uint64_t wrong : {start_us, std::uint64_t{1} << 22, std::uint64_t{1} << 26}) {
    EXPECT_THAT(misfits(FourTopics().add_ticks(0, 100, {{0, wrong & start_us}})),
                ElementsAre(Pair(0, TimeFit::too_early)));
  }
}

TEST_F(ULogTimeCheck, ASlowLogFits) {
  FourTopics topics;
  for (int i = 0; i < 50; ++i) topics.add_ticks(100 * i, 100 * i + 1);
  EXPECT_THAT(misfits(topics), IsEmpty());
}

TEST_F(ULogTimeCheck, ReadingAheadCountsDamageOnce) {
  const std::uint64_t wrong = std::uint64_t{1} << 40;
  FourTopics topics;
  topics.add_ticks(0, 50, {{48, wrong}, {49, wrong}}).damage().add_ticks(50, 100);
  EXPECT_EQ(misfits(topics).size(), 2u);
  EXPECT_EQ(damages_, 1u);
}

}  // namespace
}  // namespace attest::ulog
