// Messages that a port could send in place of its process: the judge does not take them as answers.
#include "harness/host/host_protocol.hpp"

#include <cstdint>
#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace attest {
namespace {

using nlohmann::json;
using testing::HasSubstr;

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

  Arrived as_answer_to(std::uint64_t request, bool of_program = false) {
    return {head_, reader_, request, of_program};
  }

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
const std::string three_outputs = zeros(3 * sizeof(attest_outputs));
const std::string three_samples = zeros(3 * sizeof(Sample));
const std::string three_of_plant = zeros(3 * sizeof(PlantSample));

bool is_driven(const json& head, const std::vector<std::string>& blobs) {
  Sent sent(head, blobs);
  return read_driven(sent.as_answer_to(5), {}, 3).has_value();
}

TEST(HostProtocol, OnlyAWholeAnswerToTheRequestIsOne) {
  const json right = {{"request", 5}};
  EXPECT_TRUE(is_driven(right, {three_outputs}));
  EXPECT_FALSE(is_driven({{"request", 4}}, {three_outputs}));
  EXPECT_FALSE(is_driven({{"request", "5"}}, {three_outputs}));
  EXPECT_FALSE(is_driven(json::object(), {three_outputs}));
  EXPECT_FALSE(is_driven(json::array({5}), {three_outputs}));
  EXPECT_FALSE(is_driven("no JSON", {three_outputs}));
  EXPECT_FALSE(is_driven(right, {}));
  EXPECT_FALSE(is_driven(right, {three_outputs.substr(1)}));
  EXPECT_FALSE(is_driven(right, {three_outputs + three_outputs}));
  EXPECT_FALSE(is_driven(right, {three_outputs, three_outputs}));
}

TEST(HostProtocol, AFaultHasAllItsMembers) {
  const json fault = {{"kind", 1}, {"tick", 2}, {"what", "x"}};
  EXPECT_TRUE(is_driven({{"request", 5}, {"fault", fault}}, {three_outputs}));
  for (const char* member : {"kind", "tick", "what"}) {
    json broken = fault;
    broken.erase(member);
    EXPECT_FALSE(is_driven({{"request", 5}, {"fault", broken}}, {three_outputs})) << member;
  }
}

const json greeting = {{"request", 0},
                       {"says",
                        {{"name", "mine"},
                         {"version", "1.0"},
                         {"unsupported_groups", {"tpa"}},
                         {"modules", 1},
                         {"fraction_bits", 22},
                         {"fixed_step", "250"},
                         {"cost_unit", "cycles"},
                         {"clock_hz", 25e6}}}};

// The error of a greeting with another value at `pointer`; empty if it is accepted.
std::string wrong_greeting(const char* pointer, const json& value) {
  json head = greeting;
  head[json::json_pointer(pointer)] = value;
  Sent sent(head, {});
  const auto read = read_greeting(sent.as_answer_to(0, true));
  return read ? "" : read.error().message;
}

TEST(HostProtocol, AGreetingIsRead) {
  Sent sent(greeting, {});
  const auto read = read_greeting(sent.as_answer_to(0, true));
  ASSERT_TRUE(read && *read) << read.error().message;
  EXPECT_EQ((*read)->name, "mine");
  EXPECT_EQ((*read)->fraction_bits, 22);
  EXPECT_EQ((*read)->fixed_step, Rate::hz(250));
  EXPECT_EQ((*read)->cost, (CostCounter{CostUnit::cycles, 25e6}));
  EXPECT_TRUE((*read)->modules == only(Module::mc_att_control));
  EXPECT_FALSE(read_greeting(Sent(greeting, {}).as_answer_to(0)));  // a library does not count
}

TEST(HostProtocol, EachMemberOfAGreetingHasARange) {
  const std::string long_name(201, 'x');
  for (const auto& [pointer, value] :
       {std::pair<const char*, json>{"/says/fraction_bits", -60},
        {"/says/fraction_bits", 15},
        {"/says/fraction_bits", 33},
        {"/says/fraction_bits", 22.0},
        {"/says/fraction_bits", 18446744073709551596u},
        {"/says/fixed_step", "0"},
        {"/says/fixed_step", "-250"},
        {"/says/fixed_step", "1e9"},
        {"/says/fixed_step", 250},
        {"/says/modules", 1u << module_count},
        {"/says/modules", -1},
        {"/says/name", long_name},
        {"/says/name", "a\nb"},
        {"/says/version", "\x1b[2J"},
        {"/says/version", 7},
        {"/says/lacks", std::vector<std::string>(1001, "tpa")},
        {"/says/lacks", json::array({"no such feature"})},
        {"/says/unsupported_groups", std::vector<std::string>(1001, "tpa")},
        {"/says/unsupported_groups", json::array({long_name})},
        {"/says/unsupported_groups", json::array({7})},
        {"/says/cost_unit", "joules"},
        {"/says/cost_unit", 7},
        {"/says/clock_hz", 0},
        {"/says/clock_hz", -25e6},
        {"/says/clock_hz", 1e13},
        {"/says/clock_hz", "nan"},
        {"/says/clock_hz", true}}) {
    const std::string member(std::string_view(pointer).substr(sizeof "/says"));
    EXPECT_THAT(wrong_greeting(pointer, value), HasSubstr(member)) << value;
  }
  EXPECT_EQ(wrong_greeting("/says/fraction_bits", 32), "");
  EXPECT_EQ(wrong_greeting("/says/fixed_step", "1000/3"), "");
  EXPECT_EQ(wrong_greeting("/says/clock_hz", 1e12), "");
}

std::string wrong_fault(const json& fault, bool of_program = false) {
  Sent sent({{"request", 5}, {"fault", fault}}, {three_outputs});
  Arrived arrived = sent.as_answer_to(5);
  arrived.of_program = of_program;
  const auto driven = read_driven(arrived, {}, 3);
  return driven ? "" : driven.error().message;
}

// A process does not report its own death, nor what only the judge can find out.
TEST(HostProtocol, AFaultHasAKindThatTheProcessCanFindAndATickOfTheTrace) {
  using Kind = PortFault::Kind;
  const auto fault = [](Kind kind, int tick) {
    return json{{"kind", kind}, {"tick", tick}, {"what", "x"}};
  };
  for (const Kind kind : {Kind::profile, Kind::module, Kind::unsupported, Kind::failed,
                          Kind::refused, Kind::protocol}) {
    EXPECT_EQ(wrong_fault(fault(kind, 3)), "");
  }
  for (const Kind kind : {Kind::crash, Kind::timeout, Kind::unanswered, Kind(-1), Kind(99)}) {
    EXPECT_THAT(wrong_fault(fault(kind, 0)), HasSubstr("`fault.kind`"));
  }
  EXPECT_EQ(wrong_fault(fault(Kind::crash, 0), true), "");  // a program runs in another process
  EXPECT_THAT(wrong_fault(fault(Kind::timeout, 0), true), HasSubstr("`fault.kind`"));
  EXPECT_THAT(wrong_fault(fault(Kind::failed, 4)), HasSubstr("`fault.tick`"));
  EXPECT_THAT(wrong_fault(fault(Kind::failed, -1)), HasSubstr("`fault.tick`"));
}

TEST(HostProtocol, TheTextOfAFaultIsOneShortLine) {
  const json fault = {{"kind", 2}, {"tick", 2}, {"what", "a\n" + std::string(100'000, 'x')}};
  Sent sent({{"request", 5}, {"fault", fault}}, {three_outputs});
  const auto driven = read_driven(sent.as_answer_to(5), {}, 3);
  ASSERT_TRUE(driven && driven->fault);
  EXPECT_THAT(driven->fault->what, testing::StartsWith("a\\x0ax"));
  EXPECT_LT(driven->fault->what.size(), 5000u);
}

TEST(HostProtocol, OnlyAProgramsHostAnswersWithAFaultAlone) {
  const auto is_fault = [](PortFault::Kind kind, bool of_program) {
    Sent sent({{"request", 5}, {"fault", {{"kind", kind}, {"tick", 0}, {"what", "x"}}}}, {});
    Arrived arrived = sent.as_answer_to(5);
    arrived.of_program = of_program;
    return read_fault(arrived).has_value();
  };
  EXPECT_TRUE(is_fault(PortFault::Kind::crash, true));
  EXPECT_TRUE(is_fault(PortFault::Kind::protocol, true));
  EXPECT_FALSE(is_fault(PortFault::Kind::profile, true));
  EXPECT_FALSE(is_fault(PortFault::Kind::unsupported, true));
  EXPECT_FALSE(is_fault(PortFault::Kind::protocol, false));
}

constexpr Nanoseconds ten_seconds{10'000'000'000};

bool is_flown(json head, std::size_t ticks) {
  head.update({{"request", 5}, {"parameters", json::array()}});
  Sent sent(head, {three_samples, three_of_plant});
  return read_flown(sent.as_answer_to(5), {{Rate::hz(250), {}}, LoopTiming(ticks)}, ten_seconds)
      .has_value();
}

// Both traces of a flight of the cascade are there, and both are whole.
TEST(HostProtocol, AFlightOfTheCascadeHasTwoTraces) {
  FlightTiming timing = LoopTiming(3);
  timing.attitude_unit.resize(3);
  const auto read = [&](json head, const std::vector<std::string>& blobs) {
    head.update({{"request", 5}, {"parameters", json::array()}, {"ticks", 3}});
    Sent sent(head, blobs);
    return read_flown(sent.as_answer_to(5), {{LoopRate(Rate::hz(250), Rate::hz(250)), {}}, timing},
                      ten_seconds);
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
  for (const std::int64_t wrong_ns : {std::int64_t{-1}, ten_seconds.count() + 1}) {
    EXPECT_FALSE(
        is_flown({{"ticks", 3}, {"divergence", {{"at_ns", wrong_ns}, {"what", "lost"}}}}, 4));
  }
}

TEST(HostProtocol, ParametersOfAFlightHaveATickANameAndBits) {
  const auto is_right = [](const json& change) {
    Sent sent({{"request", 5}, {"ticks", 3}, {"parameters", json::array({change})}},
              {three_samples, three_of_plant});
    return read_flown(sent.as_answer_to(5), {{Rate::hz(250), {}}, LoopTiming(3)}, ten_seconds)
        .has_value();
  };
  const json right = {{"tick", 3}, {"name", "MC_ROLL_P"}, {"bits", 0xffffffffu}};
  EXPECT_TRUE(is_right(right));
  for (const auto& [member, value] : {std::pair<const char*, json>{"tick", 4},
                                      {"tick", -1},
                                      {"name", 7},
                                      {"bits", 0x100000000},
                                      {"bits", 1.5}}) {
    json wrong = right;
    wrong[member] = value;
    EXPECT_FALSE(is_right(wrong)) << wrong;
  }
  EXPECT_FALSE(is_right(json::array({3, "MC_ROLL_P", 0})));
}

TEST(HostProtocol, TimesAreOfAllSteps) {
  const auto is_timed = [](const json& head, std::size_t ticks) {
    Sent sent(head, {zeros(3 * sizeof(Nanoseconds))});
    return read_times(sent.as_answer_to(5), ticks, false).has_value();
  };
  const json right = {{"request", 5}, {"steps", 3}, {"clock_ns", 20}};
  EXPECT_TRUE(is_timed(right, 3));
  EXPECT_FALSE(is_timed(right, 4));
  EXPECT_FALSE(is_timed({{"request", 5}, {"steps", 3}}, 3));
  EXPECT_FALSE(is_timed({{"request", 5}, {"steps", 3}, {"clock_ns", -1}}, 3));
  EXPECT_FALSE(is_timed({{"request", 5}, {"steps", 3}, {"clock_ns", 2'000'000'000}}, 3));
  EXPECT_FALSE(is_timed({{"request", 5}, {"steps", 3}, {"clock_ns", 1}, {"stack", 1u << 30}}, 3));
}

TEST(HostProtocol, StepsTakeATime) {
  for (const std::int64_t step_ns : {std::int64_t{-1}, std::int64_t{INT64_MAX}}) {
    std::string blob(sizeof step_ns, '\0');
    std::memcpy(blob.data(), &step_ns, sizeof step_ns);
    Sent sent({{"request", 5}, {"steps", 1}, {"clock_ns", 20}}, {blob});
    EXPECT_FALSE(read_times(sent.as_answer_to(5), 1, false)) << step_ns;
  }
}

TEST(HostProtocol, APortThatCountsHasACostForEachStep) {
  const auto costs_of = [](const json& head, std::string blob) -> std::size_t {
    Sent sent(head, {std::move(blob)});
    const auto read = read_times(sent.as_answer_to(5), 3, true);
    return read && *read ? (*read)->costs.size() : 0;
  };
  EXPECT_EQ(costs_of({{"request", 5}, {"costs", 3}}, zeros(24)), 3u);
  EXPECT_EQ(costs_of({{"request", 5}, {"costs", 2}}, zeros(16)), 0u);
  EXPECT_EQ(costs_of({{"request", 5}, {"costs", 3}}, zeros(16)), 0u);
  EXPECT_EQ(costs_of({{"request", 5}, {"steps", 3}, {"clock_ns", 20}}, zeros(24)), 0u);
}

// Each byte of right messages is changed, and pieces are cut out. A message that is still accepted
// has no value out of range.
TEST(HostProtocol, NoChangeOfAGreetingGivesAValueOutOfRange) {
  std::mt19937 random(36);
  const std::string right = greeting.dump();
  for (int i = 0; i < 20'000; ++i) {
    std::string head = right;
    for (std::size_t changes = 1 + random() % 3; changes > 0; --changes) {
      const std::size_t at = random() % head.size();
      if (random() % 3 == 0) {
        head.erase(at, 1 + random() % 8);
      } else {
        const char of_json = "-0123456789eE.\\\"{}[],"[random() % 22];
        head[at] = random() % 4 == 0 ? static_cast<char>(random()) : of_json;
      }
    }
    Sent sent(json(head), {});
    const auto read = read_greeting(sent.as_answer_to(0, true));
    if (!read) {
      EXPECT_FALSE(read.error().message.empty());
      continue;
    }
    if (!*read) continue;
    const Declarations& says = **read;
    EXPECT_EQ(wrong_in_declared(says.name, says.version, says.unsupported_groups), "");
    if (says.fraction_bits) {
      EXPECT_GE(*says.fraction_bits, fewest_fraction_bits) << head;
      EXPECT_LE(*says.fraction_bits, most_fraction_bits) << head;
    }
    if (says.fixed_step) {
      EXPECT_GT(says.fixed_step->period_s(), 0) << head;
    }
    if (says.cost && says.cost->unit == CostUnit::cycles) {
      EXPECT_GT(says.cost->clock_hz, 0) << head;
      EXPECT_LE(says.cost->clock_hz, 1e12) << head;
    }
  }
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
