#include "harness/host/live_message.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "harness/core/json_text.hpp"
#include "harness/core/printable.hpp"
#include "harness/loop/timing_file.hpp"

namespace attest {
namespace {

using nlohmann::json;

Usage usage_from(JsonReader in, Nanoseconds longest) {
  return {Nanoseconds(in.integer("cpu_ns", 0, longest.count())), in.integer("allocations", 0),
          in.integer("page_faults", 0), in.integer("yields", 0), in.integer("preemptions", 0)};
}

json to_json(const Histogram& histogram) {
  json out = {{"min_ns", histogram.min().count()}, {"max_ns", histogram.max().count()}};
  json& buckets = out["buckets"] = json::array();
  for (const Histogram::Bucket& bucket : histogram.buckets()) {
    buckets.push_back({{"from_ns", bucket.from.count()}, {"count", bucket.count}});
  }
  return out;
}

Histogram histogram_from(JsonReader in, Nanoseconds longest) {
  constexpr std::uint64_t most_steps = 1'000'000'000'000;  // of the plant
  const Nanoseconds max(in.integer("max_ns", 0, longest.count()));
  const Nanoseconds min(in.integer("min_ns", 0, max.count()));
  Histogram histogram;
  std::string error;
  for (const json& one : in.list("buckets")) {
    JsonReader bucket(one, error);
    const Nanoseconds from(bucket.integer("from_ns", 0, longest.count()));
    histogram.add(std::clamp(from, std::min(min, max), max), bucket.count("count", most_steps));
  }
  for (const Nanoseconds end : {min, max}) histogram.add(end, 0);
  if (!error.empty()) in.wrong("buckets", "has a wrong bucket: " + error);
  return histogram;
}

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
  const auto is_never = [](Nanoseconds time) { return time == Nanoseconds(-1); };
  return has_valid_flag(tick) && tick.release_number >= 0 && in_flight(tick.release) &&
         in_flight(tick.deadline) && in_flight(tick.start) &&
         (in_flight(tick.sampled) || is_never(tick.sampled)) && in_flight(tick.begins) &&
         in_flight(tick.finish) && in_flight(tick.elapsed) && in_flight(tick.cpu) &&
         (in_flight(tick.commanded) || is_never(tick.commanded)) && tick.cost >= -1 &&
         tick.cost <= UINT32_MAX && is_never(tick.counted);
}

// `most`: the most ticks that the unit can have.
LiveUnitRecord unit_from(const LiveRequest& request, std::size_t most, bool of_program,
                         JsonReader head, BlobReader& blobs) {
  LiveUnitRecord unit;
  const auto ticks = static_cast<std::size_t>(head.count("ticks", most));
  unit.ticks = objects_from<LiveTick>(blobs, ticks, "ticks", head);
  unit.samples =
      objects_from<Sample>(blobs, std::min(ticks, request.plan.samples), "samples", head);
  unit.skipped = head.count("skipped", most - ticks);
  unit.usage = usage_from(head.object("usage"), request.longest);
  unit.changes = changes_from(head, "parameters", most);
  unit.fault = fault_from(head, most, of_program);
  std::uint64_t skipped = 0;
  for (const LiveTick& tick : unit.ticks) {
    if (!is_sane(tick, request.longest)) head.wrong("ticks", "has a time out of the flight");
    skipped += tick.skipped;
  }
  if (skipped > unit.skipped) head.wrong("skipped", "is less than the ticks have");
  return unit;
}

// A flight may be shorter than its case only after a request to stop, a fault or a divergence, or
// with a unit that the estimator triggers.
bool may_be_short(const LiveRequest& request, const LiveFlight& flight) {
  const bool has_fault = flight.unit.fault || (flight.attitude_unit && flight.attitude_unit->fault);
  return request.was_asked_to_stop || has_fault || flight.plant.divergence ||
         request.the_case.unit.on_estimate;
}

// Reads the units of the flight, and reports those that are shorter than the case.
void read_units(const LiveRequest& request, bool of_program, JsonReader& head, BlobReader& blobs,
                LiveFlight& flight) {
  const LoopRate& rate = request.plan.configuration.rate;
  std::vector<Rate> rates{rate.motor_unit};
  if (request.the_case.attitude_loop) rates.push_back(*rate.attitude_unit);
  const json& heads = head.list("units");
  if (heads.size() != rates.size()) {
    return head.wrong("units", "does not have the units of the flight");
  }
  bool is_whole = true;
  std::string error;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const auto most = static_cast<std::size_t>(tick_count(request.the_case.duration, rates[i]));
    LiveUnitRecord& unit = i == 0 ? flight.unit : flight.attitude_unit.emplace();
    unit = unit_from(request, most, of_program, JsonReader(heads[i], error), blobs);
    is_whole = is_whole && unit.ticks.size() + unit.skipped >= most;
  }
  if (!is_whole && !may_be_short(request, flight)) {
    head.wrong("units", "is shorter than the flight, and the message does not say why");
  }
  if (!error.empty()) return head.wrong("units", "is wrong: " + error);
  const FlightTiming timing = flight.timing();
  if (first_disorder(timing.unit) || first_disorder(timing.attitude_unit)) {
    head.wrong("units", "has ticks that are not in order");
  }
}

}  // namespace

std::string live_request(const LivePlan& plan) {
  const LiveOptions& options = plan.options;
  return text_of({{"do", "fly_live"},
                  {"configuration", to_json(plan.configuration)},
                  {"unit_cpu", options.unit_cpu},
                  {"plant_cpu", options.plant_cpu},
                  {"fifo", options.fifo},
                  {"spin_ns", options.wait.spin.count()},
                  {"samples", plan.samples}});
}

LivePlan live_plan_from(const json& head) {
  return {configuration_from(head.at("configuration")),
          {head.at("unit_cpu").get<int>(),
           head.at("plant_cpu").get<int>(),
           head.at("fifo").get<bool>(),
           {Nanoseconds(head.at("spin_ns").get<std::int64_t>())}},
          head.at("samples").get<std::size_t>()};
}

json to_json(const Usage& usage) {
  return {{"cpu_ns", usage.cpu.count()},
          {"allocations", usage.allocations},
          {"page_faults", usage.page_faults},
          {"yields", usage.yields},
          {"preemptions", usage.preemptions}};
}

json to_json(const std::vector<RealtimePrivilege>& privileges) {
  json list = json::array();
  for (const auto& [name, got, why] : privileges) {
    list.push_back({{"name", name}, {"got", got}, {"why", why}});
  }
  return list;
}

json live_json(const LiveFlight& flight, std::vector<Blob>& blobs) {
  json head = json::object();
  set_end(flight.fault, flight.plant.divergence, head);
  if (flight.fault) return head;
  head["units"] = json::array();
  const auto add = [&](const LiveUnitRecord& unit) {
    json of_unit = {{"ticks", unit.ticks.size()},
                    {"skipped", unit.skipped},
                    {"usage", to_json(unit.usage)},
                    {"parameters", changes_json(unit.changes)}};
    set_end(unit.fault, {}, of_unit);
    head["units"].push_back(std::move(of_unit));
    blobs.insert(blobs.end(), {blob_of(unit.ticks), blob_of(unit.samples)});
  };
  add(flight.unit);
  if (flight.attitude_unit) add(*flight.attitude_unit);
  head["plant"] = {{"late_steps", flight.plant.late_steps},
                   {"usage", to_json(flight.plant.usage)},
                   {"latency", to_json(flight.plant.latency)}};
  head["privileges"] = to_json(flight.privileges);
  return head;
}

LiveFlight live_from(const LiveRequest& request, bool of_program, JsonReader& head,
                     BlobReader& blobs) {
  LiveFlight flight;
  flight.fault = fault_from(head, 0, of_program);
  if (flight.fault) return flight;
  flight.plant.divergence = divergence_from(head, request.longest);
  JsonReader plant = head.object("plant");
  flight.plant.late_steps = plant.count("late_steps", UINT32_MAX);
  flight.plant.usage = usage_from(plant.object("usage"), request.longest);
  flight.plant.latency = histogram_from(plant.object("latency"), request.longest);
  std::string error;
  for (const json& one : head.list("privileges")) {
    JsonReader right(one, error);
    flight.privileges.push_back(
        {printable_part(right.text("name")), right.flag("got"), printable_part(right.text("why"))});
  }
  if (!error.empty()) head.wrong("privileges", "is wrong: " + error);
  read_units(request, of_program, head, blobs, flight);
  return flight;
}

}  // namespace attest
