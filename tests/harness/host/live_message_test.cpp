// Answers that a port could send in place of its process, of a flight in real time.
#include "harness/host/live_message.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"

namespace attest {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr Nanoseconds period{4'000'000};
constexpr std::size_t blob_of_ticks = 0;

LiveTick tick_at(std::int64_t number) {
  LiveTick tick;
  tick.release_number = number;
  tick.release = tick.start = tick.sampled = tick.begins = number * period;
  tick.deadline = tick.release + period;
  tick.finish = tick.begins + Nanoseconds(1000);
  tick.commanded = tick.begins;
  return tick;
}

// A flight of three ticks, as the port's process sends it. The first two samples are kept.
class Message {
 public:
  Message() {
    the_case_.duration = {3, Span::In::ticks};
    for (const std::int64_t number : {0, 1, 2}) flight_.unit.ticks.push_back(tick_at(number));
    flight_.unit.samples.resize(2);
    flight_.unit.changes = {{0, "MC_ROLL_P", 6.5f}};
    flight_.unit.usage = {Nanoseconds(1), 2, 3, 4, 5};
    flight_.plant.usage = {Nanoseconds(6), 7, 8, 9, 10};
    for (const std::int64_t latency : {1507, 1511, 90'000}) {
      flight_.plant.latency.add(Nanoseconds(latency));
    }
    flight_.plant.late_steps = 4;
    flight_.privileges = {{"mlockall", false, "no \x1b"}};
    std::vector<Blob> sent;
    head = json_from(text_of(live_json(flight_, sent)));
    for (const Blob& blob : sent) {
      blobs.emplace_back(static_cast<const char*>(blob.data), blob.size);
    }
  }

  json head;
  std::vector<std::string> blobs;
  bool was_asked_to_stop = false;

  template <typename Value>
  void set(std::size_t blob, std::size_t at, const Value& value) {
    std::memcpy(blobs[blob].data() + at, &value, sizeof value);
  }

  // `error` receives the error in the message; it stays empty if it is accepted.
  LiveFlight read(const json& other_head, std::string& error) const {
    std::size_t next = 0;
    std::vector<std::size_t> sizes;
    for (const std::string& blob : blobs) sizes.push_back(blob.size());
    BlobReader reader(sizes, [&](void* place, std::size_t size) {
      std::memcpy(place, blobs[next++].data(), size);
      return true;
    });
    const LivePlan plan{{Rate::hz(250), {}}, {}, 2};
    JsonReader of_head(other_head, error);
    return live_from({the_case_, plan, 10 * period, was_asked_to_stop}, false, of_head, reader);
  }

  std::string wrong_in(const json& other_head) const {
    std::string error;
    read(other_head, error);
    return error;
  }
  std::string wrong() const { return wrong_in(head); }

 private:
  Case the_case_;
  LiveFlight flight_;
};

TEST(LiveMessage, OfARightFlightIsAccepted) {
  const Message message;
  std::string error;
  const LiveFlight flight = message.read(message.head, error);
  EXPECT_EQ(error, "");
  EXPECT_EQ(flight.unit.ticks.size(), 3u);
  EXPECT_EQ(flight.unit.samples.size(), 2u);
  EXPECT_EQ(flight.unit.changes.size(), 1u);
  EXPECT_EQ(flight.unit.usage.preemptions, 5);
  EXPECT_EQ(flight.plant.usage.allocations, 7);
  EXPECT_EQ(flight.plant.steps(), 7u);
  EXPECT_EQ(flight.privileges.at(0).why, "no \\x1b");
  EXPECT_EQ(flight.timing().unit.at(2).commanded, 2 * period);
}

// The figures of the report are those that the port's process would have computed.
TEST(LiveMessage, AHistogramArrivesWithItsFigures) {
  const Message message;
  std::string error;
  const Histogram latency = message.read(message.head, error).plant.latency;
  EXPECT_EQ(latency.count(), 3u);
  EXPECT_EQ(latency.min(), Nanoseconds(1507));
  EXPECT_EQ(latency.max(), Nanoseconds(90'000));
  EXPECT_EQ(latency.buckets().size(), 2u);
  EXPECT_EQ(latency.buckets().at(0).count, 2u);
}

TEST(LiveMessage, AFaultComesAlone) {
  LiveFlight refused;
  refused.fault = PortFault{PortFault::Kind::profile, 0, "no unit"};
  std::vector<Blob> blobs;
  Message message;
  message.head = live_json(refused, blobs);
  message.blobs.clear();
  EXPECT_TRUE(blobs.empty());
  std::string error;
  EXPECT_EQ(message.read(message.head, error).fault->what, "no unit");
  EXPECT_EQ(error, "");
  message.head["fault"]["kind"] = PortFault::Kind::timeout;
  EXPECT_NE(message.wrong(), "");
}

TEST(LiveMessage, AShortFlightSaysWhy) {
  Message message;
  message.head["units"][0]["ticks"] = 2u;
  message.blobs[blob_of_ticks].resize(2 * sizeof(LiveTick));
  EXPECT_THAT(message.wrong(), HasSubstr("does not say why"));
  message.was_asked_to_stop = true;
  EXPECT_EQ(message.wrong(), "");
  message.was_asked_to_stop = false;
  message.head["units"][0]["skipped"] = 1u;
  EXPECT_EQ(message.wrong(), "");
  message.head["units"][0]["skipped"] = 0u;
  message.head["divergence"] = {{"at_ns", 1}, {"what", "lost"}};
  EXPECT_EQ(message.wrong(), "");
}

TEST(LiveMessage, TheTimesOfATickAreThoseOfTheFlight) {
  for (const std::size_t member :
       {offsetof(LiveTick, release_number), offsetof(LiveTick, release),
        offsetof(LiveTick, deadline), offsetof(LiveTick, start), offsetof(LiveTick, begins),
        offsetof(LiveTick, finish), offsetof(LiveTick, elapsed), offsetof(LiveTick, cpu),
        offsetof(LiveTick, sampled), offsetof(LiveTick, commanded)}) {
    Message message;
    message.set(blob_of_ticks, member, std::int64_t{-5});
    EXPECT_THAT(message.wrong(), HasSubstr("ticks")) << member;
  }
  for (const std::size_t member : {offsetof(LiveTick, release), offsetof(LiveTick, finish)}) {
    Message message;
    message.set(blob_of_ticks, member, std::int64_t{INT64_MAX});
    EXPECT_THAT(message.wrong(), HasSubstr("out of the flight")) << member;
  }
}

// Another byte is no bool: reading it would be undefined behaviour.
TEST(LiveMessage, AFlagIsZeroOrOne) {
  Message message;
  message.set(blob_of_ticks, offsetof(LiveTick, waited), std::uint8_t{1});
  EXPECT_EQ(message.wrong(), "");
  message.set(blob_of_ticks, offsetof(LiveTick, waited), std::uint8_t{7});
  EXPECT_THAT(message.wrong(), HasSubstr("ticks"));
}

TEST(LiveMessage, TicksAndCommandsAreInOrder) {
  Message message;
  message.set(blob_of_ticks, sizeof(LiveTick) + offsetof(LiveTick, begins), std::int64_t{0});
  EXPECT_THAT(message.wrong(), HasSubstr("not in order"));
  Message other;
  other.set(blob_of_ticks, offsetof(LiveTick, commanded), 2 * period.count());
  EXPECT_THAT(other.wrong(), HasSubstr("not in order"));
  other.set(blob_of_ticks, offsetof(LiveTick, commanded), std::int64_t{-1});
  EXPECT_EQ(other.wrong(), "") << "a command that no motor followed";
}

// The judge takes time for each skipped release.
TEST(LiveMessage, TicksSkipNoMoreThanTheirUnit) {
  Message message;
  message.set(blob_of_ticks, offsetof(LiveTick, skipped), UINT32_MAX);
  EXPECT_THAT(message.wrong(), HasSubstr("skipped"));
}

TEST(LiveMessage, EachMemberHasARange) {
  const Message right;
  constexpr std::int64_t longest_ns = 10 * period.count();
  for (const auto& [pointer, value] :
       {std::pair<const char*, json>{"/units/0/ticks", 4u},
        {"/units/0/ticks", 2u},
        {"/units/0/skipped", 1u},
        {"/units/0/usage/cpu_ns", -1},
        {"/units/0/usage/cpu_ns", longest_ns + 1},
        {"/units/0/usage/allocations", 1e300},
        {"/units/0/parameters/0/tick", 4u},
        {"/units/0/fault", {{"kind", 9}, {"tick", 0u}, {"what", ""}}},
        {"/units/0/fault", {{"kind", 2}, {"tick", 4u}, {"what", ""}}},
        {"/plant/late_steps", -1},
        {"/plant/usage/yields", "x"},
        {"/plant/latency/min_ns", longest_ns + 1},
        {"/plant/latency/max_ns", INT64_MAX},
        {"/plant/latency/buckets/0/from_ns", -1},
        {"/plant/latency/buckets/0/count", UINT64_MAX},
        {"/privileges/0/got", 1},
        {"/divergence", {{"at_ns", INT64_MAX}, {"what", ""}}},
        {"/units", json::array()}}) {
    json head = right.head;
    head[json::json_pointer(pointer)] = value;
    EXPECT_NE(right.wrong_in(head), "") << pointer << ' ' << value;
  }
}

// Right messages with a few changed bytes: each is accepted or refused, without a crash.
TEST(LiveMessage, NoChangeOfTheBytesIsDangerous) {
  std::mt19937 random(36);
  std::size_t refused = 0;
  for (int i = 0; i < 3000; ++i) {
    Message message;
    std::string head = text_of(message.head);
    head[random() % head.size()] = "-0123456789e.\"{}[],"[random() % 18];
    std::string& blob = message.blobs[blob_of_ticks];
    blob[random() % blob.size()] = static_cast<char>(random());
    message.head = json_from(head);
    refused += message.wrong().empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 1000u);
}

}  // namespace
}  // namespace attest
