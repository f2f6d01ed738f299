// Messages that a port could send in place of the child of a stress run.
#include "harness/measure/stress_message.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "harness/core/json_text.hpp"

namespace attest {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr Nanoseconds period{4'000'000};

LiveTick tick_at(std::int64_t number) {
  LiveTick tick;
  tick.release_number = number;
  tick.release = tick.start = tick.sampled = tick.begins = number * period;
  tick.deadline = tick.release + period;
  tick.finish = tick.begins + Nanoseconds(1000);
  return tick;
}

// A flight of three ticks, as its child sends it.
class Message {
 public:
  Message() {
    task_.the_case.duration = {3, Span::In::ticks};
    task_.configuration.rate = Rate::hz(250);
    StressMeasurement measured;
    measured.stress.result.rate = Rate::hz(250);
    measured.stress.ticks = 3;
    LiveFlight& flight = measured.flight.emplace();
    for (const std::int64_t number : {0, 1, 2}) {
      flight.unit.ticks.push_back(tick_at(number));
      flight.plant.commanded.push_back(flight.unit.ticks.back().begins);
    }
    flight.unit.samples.resize(3);
    flight.unit.changes = {{0, "MC_ROLL_P", 6.5f}};
    receive(measured);
  }

  json head;
  std::vector<std::string> blobs;

  template <typename Value>
  void set(std::size_t blob, std::size_t at, const Value& value) {
    std::memcpy(blobs[blob].data() + at, &value, sizeof value);
  }

  // The error in the message; empty if it is accepted.
  std::string wrong() const { return wrong_in(head); }

  std::string wrong_in(const json& other_head) const {
    std::size_t next = 0;
    std::vector<std::size_t> sizes;
    for (const std::string& blob : blobs) sizes.push_back(blob.size());
    BlobReader reader(sizes, [&](void* place, std::size_t size) {
      std::memcpy(place, blobs[next++].data(), size);
      return true;
    });
    std::string error;
    JsonReader of_head(other_head, error);
    const auto measured = measurement_from(task_, false, false, of_head, reader);
    if (error.empty()) {
      EXPECT_EQ(measured.flight->unit.ticks.size(), 3u);
    }
    return error;
  }

 private:
  void receive(const StressMeasurement& measured) {
    int ends[2] = {-1, -1};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    MessageSocket child(ends[0]), parent(ends[1]);
    send_measured(measured, child);
    const Received received = parent.receive();
    head = json_from(received.head);
    for (const std::size_t size : received.blobs) {
      blobs.emplace_back(size, '\0');
      parent.receive_blob(blobs.back().data(), size);
    }
  }

  StressTask task_;
};

TEST(StressMessage, OfARightFlightIsAccepted) { EXPECT_EQ(Message().wrong(), ""); }

constexpr std::size_t samples = 0, ticks = 1, commands = 2;

TEST(StressMessage, TheTimesOfATickAreThoseOfTheFlight) {
  for (const std::size_t member :
       {offsetof(LiveTick, release_number), offsetof(LiveTick, release),
        offsetof(LiveTick, deadline), offsetof(LiveTick, start), offsetof(LiveTick, begins),
        offsetof(LiveTick, finish), offsetof(LiveTick, elapsed), offsetof(LiveTick, cpu)}) {
    Message message;
    message.set(ticks, member, std::int64_t{-5});
    EXPECT_THAT(message.wrong(), HasSubstr("ticks")) << member;
  }
  for (const std::size_t member : {offsetof(LiveTick, release), offsetof(LiveTick, finish)}) {
    Message message;
    message.set(ticks, member, std::int64_t{INT64_MAX});
    EXPECT_THAT(message.wrong(), HasSubstr("out of the flight")) << member;
  }
}

// Another byte is no bool: reading it would be undefined behaviour.
TEST(StressMessage, AFlagIsZeroOrOne) {
  Message message;
  message.set(ticks, offsetof(LiveTick, waited), std::uint8_t{1});
  EXPECT_EQ(message.wrong(), "");
  message.set(ticks, offsetof(LiveTick, waited), std::uint8_t{7});
  EXPECT_THAT(message.wrong(), HasSubstr("ticks"));
}

TEST(StressMessage, TicksAndCommandsAreInOrder) {
  Message message;
  message.set(ticks, sizeof(LiveTick) + offsetof(LiveTick, begins), std::int64_t{0});
  EXPECT_THAT(message.wrong(), HasSubstr("not in order"));
  Message other;
  other.set(commands, 0, 2 * period.count());
  EXPECT_THAT(other.wrong(), HasSubstr("not in order"));
  other.set(commands, 0, std::int64_t{-2});
  EXPECT_THAT(other.wrong(), HasSubstr("commanded"));
  other.set(commands, 0, std::int64_t{-1});
  EXPECT_EQ(other.wrong(), "") << "a command that no motor followed";
}

TEST(StressMessage, EachMemberHasARange) {
  const Message right;
  for (const auto& [pointer, value] : {std::pair<const char*, json>{"/units/0/ticks", 4},
                                       {"/units/0/samples", -1},
                                       {"/units/0/stress/wall_ns", -1},
                                       {"/units/0/stress/wall_ns", 1e300},
                                       {"/units/0/stress/deadlines", -1},
                                       {"/units/0/stress/unit/cpu_ns", -1},
                                       {"/units/0/stress/wake_up_latency/min_ns", INT64_MAX},
                                       {"/units/0/stress/slow_steps/count", "x"},
                                       {"/units/0/parameters/0/tick", 4},
                                       {"/units/0/fault", {{"kind", 9}, {"tick", 0}, {"what", ""}}},
                                       {"/units/0/fault", {{"kind", 2}, {"tick", 4}, {"what", ""}}},
                                       {"/divergence", {{"at_ns", INT64_MAX}, {"what", ""}}},
                                       {"/units", json::array()}}) {
    json head = right.head;
    head[json::json_pointer(pointer)] = value;
    EXPECT_NE(right.wrong_in(head), "") << pointer << ' ' << value;
  }
}

// Right messages with a few changed bytes: each is accepted or refused, without a crash.
TEST(StressMessage, NoChangeOfTheBytesIsDangerous) {
  std::mt19937 random(36);
  std::size_t refused = 0;
  for (int i = 0; i < 3000; ++i) {
    Message message;
    std::string head = text_of(message.head);
    head[random() % head.size()] = "-0123456789e.\"{}[],"[random() % 18];
    std::string& blob = message.blobs[1 + random() % 2];
    blob[random() % blob.size()] = static_cast<char>(random());
    message.head = json_from(head);
    refused += message.wrong().empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 1000u);
}

}  // namespace
}  // namespace attest
