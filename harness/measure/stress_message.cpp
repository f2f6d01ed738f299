#include "harness/measure/stress_message.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <list>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/loop/timing_file.hpp"
#include "harness/measure/stress_json.hpp"

namespace attest {
namespace {

using nlohmann::json;

using Times = std::vector<std::optional<Nanoseconds>>;

std::vector<std::int64_t> numbers_of(const Times& times) {
  std::vector<std::int64_t> numbers;
  for (const auto& time : times) numbers.push_back(time ? time->count() : -1);
  return numbers;
}

// The next blob, which has as many objects as the head says, at most `most`.
template <typename T>
std::vector<T> some_from(JsonReader& head, const char* key, std::size_t most, BlobReader& blobs) {
  auto objects = blobs.read<T>(static_cast<std::size_t>(head.count(key, most)));
  if (objects) return *std::move(objects);
  head.wrong(key, "is not the number of objects that follow");
  return {};
}

struct MeasuredUnit {
  StressResult stress;
  LiveUnitRecord record;
  Times commanded;
  std::size_t most = 0;  // the most ticks that the unit can have

  bool is_whole() const { return record.ticks.size() + stress.misses.skipped >= most; }
};

// Reads raw bytes: another value than 0 and 1 is no bool.
bool has_valid_flag(const LiveTick& tick) {
  unsigned char flag = 0;
  std::memcpy(&flag, reinterpret_cast<const unsigned char*>(&tick) + offsetof(LiveTick, waited), 1);
  return flag <= 1;
}

// Whether the times are those of a flight that lasts at most `longest`.
bool is_sane(const LiveTick& tick, Nanoseconds longest) {
  const auto in_flight = [&](Nanoseconds time) {
    return time >= Nanoseconds(0) && time <= longest;
  };
  return has_valid_flag(tick) && tick.release_number >= 0 && in_flight(tick.release) &&
         in_flight(tick.deadline) && in_flight(tick.start) &&
         (in_flight(tick.sampled) || tick.sampled == Nanoseconds(-1)) && in_flight(tick.begins) &&
         in_flight(tick.finish) && in_flight(tick.elapsed) && in_flight(tick.cpu);
}

Times times_from(const std::vector<std::int64_t>& numbers, Nanoseconds longest, JsonReader& head) {
  Times times;
  for (const std::int64_t number : numbers) {
    if (number < -1 || number > longest.count()) head.wrong("commanded", "has a wrong time");
    times.push_back(number < 0 ? std::nullopt : std::optional(Nanoseconds(number)));
  }
  return times;
}

// Reads the part for one unit from the message of a flight.
MeasuredUnit unit_from(JsonReader head, std::size_t most, Nanoseconds longest, bool of_program,
                       BlobReader& blobs) {
  MeasuredUnit unit;
  auto stress = stress_from_json(head.member("stress"));
  if (!stress) head.wrong("stress", "is wrong: " + stress.error().message);
  if (stress) unit.stress = *std::move(stress);
  unit.most = most;
  unit.record.samples = some_from<Sample>(head, "samples", most, blobs);
  unit.record.ticks = some_from<LiveTick>(head, "ticks", most, blobs);
  unit.commanded =
      times_from(some_from<std::int64_t>(head, "commanded", most, blobs), longest, head);
  unit.record.changes = changes_from(head, "parameters", most);
  unit.record.fault = fault_from(head, most, of_program);
  const auto& ticks = unit.record.ticks;
  if (unit.commanded.size() < ticks.size() || ticks.size() != unit.stress.ticks ||
      unit.record.samples.size() != std::min(ticks.size(), checked_ticks)) {
    head.wrong("ticks", "is not the number of samples, commands and measured steps");
  }
  const auto is_wrong = [&](const LiveTick& tick) { return !is_sane(tick, longest); };
  if (std::ranges::any_of(ticks, is_wrong)) head.wrong("ticks", "has a time out of the flight");
  return unit;
}

// A flight may be shorter than its case only after a request to stop, a fault or a divergence, or
// with a unit that the estimator triggers.
bool may_be_short(const StressTask& task, const LiveFlight& flight, bool was_asked_to_stop) {
  const bool has_fault = flight.unit.fault || (flight.attitude_unit && flight.attitude_unit->fault);
  return was_asked_to_stop || has_fault || flight.plant.divergence ||
         task.the_case.unit.on_estimate;
}

}  // namespace

Nanoseconds longest_of(const StressTask& task) {
  const Nanoseconds duration = task.the_case.duration.on(task.configuration.rate.motor_unit);
  return duration + 2 * (report_every + task.timeout);
}

void send_measured(const StressMeasurement& measured, MessageSocket& parent) {
  if (!measured.flight) {
    json refused = {{"refused", true}};
    set_end(measured.refusal, std::nullopt, refused);
    parent.send(text_of(refused));
    return;
  }
  const LiveFlight& flight = *measured.flight;
  json head = {{"units", json::array()}};
  std::list<std::vector<std::int64_t>> commands;  // which the blobs refer to
  std::vector<Blob> blobs;
  const auto add = [&](const StressResult& stress, const LiveUnitRecord& unit,
                       const Times& commanded) {
    json of_unit = {{"stress", to_json(stress)},
                    {"ticks", unit.ticks.size()},
                    {"samples", unit.samples.size()},
                    {"commanded", commanded.size()},
                    {"parameters", changes_json(unit.changes)}};
    set_end(unit.fault, std::nullopt, of_unit);
    head["units"].push_back(std::move(of_unit));
    const auto& numbers = commands.emplace_back(numbers_of(commanded));
    blobs.insert(blobs.end(), {blob_of(unit.samples), blob_of(unit.ticks), blob_of(numbers)});
  };
  add(measured.stress, flight.unit, flight.plant.commanded);
  if (flight.attitude_unit) {
    add(*measured.attitude_unit, *flight.attitude_unit, flight.unit.setpoints_received);
  }
  set_end(std::nullopt, flight.plant.divergence, head);
  parent.send(text_of(head), blobs);
}

StressMeasurement measurement_from(const StressTask& task, bool of_program, bool was_asked_to_stop,
                                   JsonReader& head, BlobReader& blobs) {
  const LoopRate& rate = task.configuration.rate;
  std::vector<Rate> rates{rate.motor_unit};
  if (task.the_case.attitude_loop) rates.push_back(*rate.attitude_unit);
  StressMeasurement measured;
  const json& heads = head.list("units");
  if (heads.size() != rates.size()) head.wrong("units", "does not have the units of the flight");
  if (heads.size() != rates.size()) return measured;
  std::string error;
  std::vector<MeasuredUnit> units;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const auto most = static_cast<std::size_t>(tick_count(task.the_case.duration, rates[i]));
    units.push_back(
        unit_from(JsonReader(heads[i], error), most, longest_of(task), of_program, blobs));
  }
  if (!error.empty()) head.wrong("units", "is wrong: " + error);
  if (blobs.left() != 0) head.wrong("it has more data than its head says");
  LiveFlight& flight = measured.flight.emplace();
  flight.plant.divergence = divergence_from(head, longest_of(task));
  const bool is_whole =
      std::all_of(units.begin(), units.end(), std::mem_fn(&MeasuredUnit::is_whole));
  measured.stress = std::move(units.front().stress);
  flight.unit = std::move(units.front().record);
  flight.plant.commanded = std::move(units.front().commanded);
  if (units.size() > 1) {
    measured.attitude_unit = std::move(units.back().stress);
    flight.attitude_unit = std::move(units.back().record);
    flight.unit.setpoints_received = std::move(units.back().commanded);
  }
  if (!is_whole && !may_be_short(task, flight, was_asked_to_stop)) {
    head.wrong("units", "is shorter than the flight, and the message does not say why");
  }
  const FlightTiming timing = error.empty() ? flight.timing() : FlightTiming();
  if (first_disorder(timing.unit) || first_disorder(timing.attitude_unit)) {
    head.wrong("units", "has ticks that are not in order");
  }
  return measured;
}

}  // namespace attest
