// The messages of a port's process (host_protocol.hpp), which its port can forge.
// An input is a letter for the kind of message, its head in JSON up to a line feed, and the bytes
// of its blobs. A message that is accepted has no value out of range.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/host/host_protocol.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

constexpr std::size_t ticks = 3;
constexpr Nanoseconds duration{1'000'000'000};

// The blobs of a message: pieces of `bytes` with these sizes.
BlobReader blobs_of(std::string_view bytes, std::vector<std::size_t> sizes) {
  return {std::move(sizes), [bytes](void* place, std::size_t size) mutable {
            const std::size_t there = std::min(size, bytes.size());
            std::memset(place, 0, size);
            std::memcpy(place, bytes.data(), there);
            bytes.remove_prefix(there);
            return true;
          }};
}

template <typename T>
bool is_accepted(const Result<T>& read) {
  if (!read) require_readable(read.error().message);
  return read.has_value();
}

void require_sane(const std::optional<PortFault>& fault, bool of_program) {
  if (!fault) return;
  const auto last = of_program ? PortFault::Kind::crash : PortFault::Kind::protocol;
  require(fault->kind >= PortFault::Kind::profile && fault->kind <= last, "a known kind of fault");
  require(fault->tick <= ticks, "a fault at a tick of the trace");
}

void require_sane(const std::vector<ParameterChange>& changes) {
  for (const ParameterChange& change : changes) {
    require(change.tick <= ticks, "a change at a tick of the trace");
  }
}

void greet(const Arrived& arrived) {
  const auto greeting = read_greeting(arrived);
  if (!is_accepted(greeting) || !is_accepted(*greeting)) return;
  const Declarations& says = **greeting;
  require(wrong_in_declared(says.name, says.version, says.unsupported_groups).empty(),
          "printable declarations");
  const int bits = says.fraction_bits.value_or(fewest_fraction_bits);
  require(bits >= fewest_fraction_bits && bits <= most_fraction_bits, "fraction bits in range");
  require(!says.fixed_step || says.fixed_step->period_s() > 0, "a positive step");
}

void drive(const Arrived& arrived) {
  const auto driven = read_driven(arrived, {}, ticks);
  if (!is_accepted(driven)) return;
  require(driven->outputs.size() == ticks * sizeof(attest_outputs), "outputs for each tick");
  require_sane(driven->fault, arrived.of_program);
}

void fly(const Arrived& arrived) {
  const FlightPlan plan{{Rate::hz(250), {}}, LoopTiming(ticks)};
  const auto flown = read_flown(arrived, plan, duration);
  if (!is_accepted(flown) || !is_accepted(*flown)) return;
  const Flown& flight = **flown;
  require(flight.trace.samples.size() <= ticks, "at most the ticks of the plan");
  require_sane(flight.fault, arrived.of_program);
  require_sane(flight.trace.parameters);
  require(!flight.divergence ||
              (flight.divergence->at >= Nanoseconds(0) && flight.divergence->at <= duration),
          "a divergence in the flight");
}

void time(const Arrived& arrived) {
  const auto times = read_times(arrived, ticks, false);
  if (!is_accepted(times) || !is_accepted(*times)) return;
  require((*times)->clock >= Nanoseconds(0), "a clock that takes time");
  for (const Nanoseconds step : (*times)->steps) require(step >= Nanoseconds(0), "a duration");
}

void fly_live(const Arrived& arrived) {
  Case the_case;
  the_case.duration = {double{ticks}, Span::In::ticks};
  const LivePlan plan{{Rate::hz(250), {}}, {}, ticks};
  const auto flown = read_live(arrived, {the_case, plan, duration});
  if (!is_accepted(flown) || !is_accepted(*flown)) return;
  require_sane((*flown)->fault, arrived.of_program);
  const LiveUnitRecord& unit = (*flown)->unit;
  require(unit.ticks.size() + unit.skipped <= ticks, "at most the ticks of the plan");
  require_sane(unit.fault, arrived.of_program);
  require_sane(unit.changes);
  for (const LiveTick& tick : unit.ticks) {
    require(tick.finish >= Nanoseconds(0) && tick.finish <= duration, "a time in the flight");
    require(tick.skipped <= ticks, "a number of skipped releases");
  }
  require((*flown)->plant.latency.min() >= Nanoseconds(0), "durations");
}

void receive(char kind, const std::string& head, std::string_view bytes) {
  constexpr std::size_t samples = ticks * sizeof(Sample);
  const auto arrives = [&](std::vector<std::size_t> sizes, auto read) {
    BlobReader blobs = blobs_of(bytes, std::move(sizes));
    read(Arrived{head, blobs, 1, head.size() % 2 == 0});
  };
  if (kind == 'g') arrives({}, greet);
  if (kind == 'd') arrives({samples}, drive);
  if (kind == 'f') arrives({samples, ticks * sizeof(PlantSample)}, fly);
  if (kind == 't') arrives({ticks * sizeof(Nanoseconds)}, time);
  if (kind == 'l') arrives({ticks * sizeof(LiveTick), samples}, fly_live);
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest;
  const std::string_view text = fuzz::text_of(data, size);
  if (text.empty()) return 0;
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view bytes = text.substr(std::min(end + 1, text.size()));
  fuzz::receive(text.front(), std::string(text.substr(1, end - 1)), bytes);
  return 0;
}
