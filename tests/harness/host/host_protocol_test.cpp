// Messages that a port could send in place of its process: the judge does not take them as answers.
#include "harness/host/host_protocol.hpp"

#include <cstring>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace attest {
namespace {

using nlohmann::json;

// A message as it arrives.
class Sent {
 public:
  Sent(json head, std::vector<std::string> blobs)
      : head_(head.is_string() ? head.get<std::string>() : head.dump()),
        blobs_(std::move(blobs)),
        reader_(sizes(blobs_), [this](void* place, std::size_t size) {
          std::memcpy(place, blobs_[next_++].data(), size);
          return true;
        }) {}

  Arrived as_answer_to(std::uint64_t request) { return {head_, reader_, request}; }

 private:
  static std::vector<std::size_t> sizes(const std::vector<std::string>& blobs) {
    std::vector<std::size_t> all;
    for (const std::string& blob : blobs) all.push_back(blob.size());
    return all;
  }

  std::string head_;
  std::vector<std::string> blobs_;
  std::size_t next_ = 0;
  BlobReader reader_;
};

std::string zeros(std::size_t count) { return std::string(count, '\0'); }
const std::string three_samples = zeros(3 * sizeof(Sample));
const std::string three_of_plant = zeros(3 * sizeof(PlantSample));

bool is_driven(const json& head, const std::vector<std::string>& blobs) {
  Sent sent(head, blobs);
  return read_driven(sent.as_answer_to(5), 3).has_value();
}

TEST(HostProtocol, OnlyAWholeAnswerToTheRequestIsOne) {
  const json right = {{"request", 5}};
  EXPECT_TRUE(is_driven(right, {three_samples}));
  EXPECT_FALSE(is_driven({{"request", 4}}, {three_samples}));
  EXPECT_FALSE(is_driven({{"request", "5"}}, {three_samples}));
  EXPECT_FALSE(is_driven(json::object(), {three_samples}));
  EXPECT_FALSE(is_driven(json::array({5}), {three_samples}));
  EXPECT_FALSE(is_driven("no JSON", {three_samples}));
  EXPECT_FALSE(is_driven(right, {}));
  EXPECT_FALSE(is_driven(right, {three_samples.substr(1)}));
  EXPECT_FALSE(is_driven(right, {three_samples + three_samples}));
  EXPECT_FALSE(is_driven(right, {three_samples, three_samples}));
}

TEST(HostProtocol, AFaultHasAllItsMembers) {
  const json fault = {{"kind", 1}, {"tick", 2}, {"what", "x"}};
  EXPECT_TRUE(is_driven({{"request", 5}, {"fault", fault}}, {three_samples}));
  for (const char* member : {"kind", "tick", "what"}) {
    json broken = fault;
    broken.erase(member);
    EXPECT_FALSE(is_driven({{"request", 5}, {"fault", broken}}, {three_samples})) << member;
  }
}

// Otherwise a port could report a crash, which does not count as a violation of the protocol.
TEST(HostProtocol, AProcessDoesNotAnnounceItsOwnDeath) {
  const json fault = {{"kind", PortFault::Kind::crash}, {"tick", 2}, {"what", "x"}};
  Sent sent({{"request", 5}, {"fault", fault}}, {three_samples});
  const auto driven = read_driven(sent.as_answer_to(5), 3);
  ASSERT_TRUE(driven && driven->fault);
  EXPECT_EQ(driven->fault->kind, PortFault::Kind::protocol);
}

// A program runs in a process of its own, so its host can.
TEST(HostProtocol, TheHostOfAProgramAnnouncesItsEnd) {
  for (const auto& [told, read] :
       {std::pair(PortFault::Kind::crash, PortFault::Kind::crash),
        std::pair(PortFault::Kind::timeout, PortFault::Kind::protocol)}) {
    const json fault = {{"kind", told}, {"tick", 2}, {"what", "x"}};
    Sent sent({{"request", 5}, {"fault", fault}}, {three_samples});
    Arrived arrived = sent.as_answer_to(5);
    arrived.of_program = true;
    const auto driven = read_driven(arrived, 3);
    ASSERT_TRUE(driven && driven->fault);
    EXPECT_EQ(driven->fault->kind, read);
  }
}

bool is_flown(json head, std::size_t ticks) {
  head.update({{"request", 5}, {"source", "x"}, {"parameters", json::array()}});
  Sent sent(head, {three_samples, three_of_plant});
  return read_flown(sent.as_answer_to(5), {{Rate::hz(250), {}}, LoopTiming(ticks)}).has_value();
}

// Both traces of a flight of the cascade are there, and both are whole.
TEST(HostProtocol, AFlightOfTheCascadeHasTwoTraces) {
  FlightTiming timing = LoopTiming(3);
  timing.attitude_unit.resize(3);
  const auto read = [&](json head, const std::vector<std::string>& blobs) {
    head.update({{"request", 5}, {"source", "x"}, {"parameters", json::array()}, {"ticks", 3}});
    Sent sent(head, blobs);
    return read_flown(sent.as_answer_to(5), {{LoopRate(Rate::hz(250), Rate::hz(250)), {}}, timing});
  };
  const json attitude = {{"attitude_ticks", 3}, {"attitude_parameters", json::array()}};
  const auto flown = read(attitude, {three_samples, three_of_plant, three_samples});
  ASSERT_TRUE(flown && *flown);
  EXPECT_EQ(module_of((*flown)->trace.present), Module::rate_unit);
  ASSERT_TRUE((*flown)->attitude_trace);
  EXPECT_EQ((*flown)->attitude_trace->samples.size(), 3u);
  EXPECT_FALSE(read(attitude, {three_samples, three_of_plant}));
  EXPECT_FALSE(read({{"attitude_ticks", 3}}, {three_samples, three_of_plant, three_samples}));
  EXPECT_FALSE(read({}, {three_samples, three_of_plant}));
}

// A flight with only its first ticks cannot be judged, unless the message gives the reason.
TEST(HostProtocol, AFlightThatEndsEarlySaysWhy) {
  EXPECT_TRUE(is_flown({{"ticks", 3}}, 3));
  EXPECT_FALSE(is_flown({{"ticks", 3}}, 4));
  EXPECT_FALSE(is_flown({{"ticks", 3}}, 2));
  EXPECT_TRUE(is_flown({{"ticks", 3}, {"divergence", {{"at_ns", 1}, {"what", "lost"}}}}, 4));
  EXPECT_FALSE(is_flown({{"ticks", 3}, {"divergence", {{"at_ns", "1"}}}}, 4));
  EXPECT_FALSE(is_flown({{"ticks", 2}}, 2));
  EXPECT_FALSE(is_flown({{"ticks", -3}}, 3));
}

TEST(HostProtocol, TimesAreOfAllSteps) {
  const auto is_timed = [](const json& head, std::size_t ticks) {
    Sent sent(head, {zeros(3 * sizeof(Nanoseconds))});
    return read_times(sent.as_answer_to(5), ticks).has_value();
  };
  const json right = {{"request", 5}, {"steps", 3}, {"clock_ns", 20}};
  EXPECT_TRUE(is_timed(right, 3));
  EXPECT_FALSE(is_timed(right, 4));
  EXPECT_FALSE(is_timed({{"request", 5}, {"steps", 3}}, 3));
}

TEST(HostProtocol, AGreetingIsWholeOrAnError) {
  Sent error({{"request", 0}, {"error", {{"message", "no such library"}}}}, {});
  const auto refused = read_greeting(error.as_answer_to(0));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->error().message, "no such library");
  Sent empty({{"request", 0}, {"says", json::object()}}, {});
  EXPECT_FALSE(read_greeting(empty.as_answer_to(0)));
}

}  // namespace
}  // namespace attest
