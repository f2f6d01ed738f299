#include "harness/casefile/parse_flight.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/casefile/parse_cascade.hpp"
#include "harness/casefile/parse_rates.hpp"
#include "harness/casefile/parse_signal.hpp"
#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

constexpr const char* default_lead = "iris";

// For the vehicles other than the lead: a slow rate, one whose period is not a whole number of
// nanoseconds, and a fast one; of the cascade, the usual pair.
std::vector<LoopRate> default_other_rates(bool is_cascade) {
  if (is_cascade) return {LoopRate(Rate::hz(250), Rate::hz(1000))};
  return {Rate::hz(100), Rate::hz(333), Rate::hz(1000)};
}

std::vector<std::string> parse_vehicles(const TomlTable& table,
                                        const std::vector<std::string>& known) {
  if (!table.has("vehicles")) return known;
  table.text("vehicles_why");  // required: a case that leaves out vehicles must say why
  std::vector<std::string> vehicles = table.texts("vehicles");
  if (vehicles.empty()) table.error("vehicles", "names no vehicle");
  for (const std::string& name : vehicles) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    table.error("vehicles", fmt::format("unknown vehicle `{}`{}; there are {}", name,
                                        suggestion(name, known), fmt::join(known, ", ")));
  }
  return vehicles;
}

std::vector<PlantKind> parse_plants(const TomlTable& table) {
  if (!table.has("plants")) return {plant_kinds.begin(), plant_kinds.end()};
  table.text("plants_why");
  std::vector<PlantKind> plants;
  for (const std::string& name : table.texts("plants")) {
    const auto kind = parse_plant_kind(name);
    if (!kind) table.error("plants", kind.error().message);
    if (kind) plants.push_back(*kind);
  }
  if (plants.empty()) table.error("plants", "names no plant");
  return plants;
}

void parse_plant_configurations(const TomlTable& table, const std::vector<std::string>& known,
                                Flight& flight) {
  const std::vector<std::string> vehicles = parse_vehicles(table, known);
  const std::vector<PlantKind> plants = parse_plants(table);
  for (const std::string& vehicle : vehicles) {
    for (const PlantKind plant : plants) flight.plant_configurations.push_back({vehicle, plant});
  }
  std::sort(flight.plant_configurations.begin(), flight.plant_configurations.end());
  if (std::adjacent_find(flight.plant_configurations.begin(), flight.plant_configurations.end()) !=
      flight.plant_configurations.end()) {
    table.error("vehicles", "names a vehicle or plant twice");
  }
  if (vehicles.empty()) return;
  const auto lead = std::find(vehicles.begin(), vehicles.end(), default_lead);
  flight.lead_vehicle = lead == vehicles.end() ? vehicles.front() : *lead;
}

std::vector<LoopRate> parse_other_rates(const TomlTable& table, const Case& parsed) {
  constexpr const char* key = "other_rates_hz";
  const bool is_cascade = parsed.attitude_loop.has_value();
  if (table.has(key)) return parse_loop_rates(table, key, is_cascade);
  std::vector<LoopRate> others = default_other_rates(is_cascade);
  std::erase_if(others, [&](const LoopRate& rate) {
    return std::find(parsed.rates.begin(), parsed.rates.end(), rate) == parsed.rates.end();
  });
  return others.empty() ? parsed.rates : others;
}

void parse_physics(const TomlTable& table, const std::vector<LoopRate>& rates, Flight& flight) {
  constexpr const char* key = "physics_hz";
  if (!table.has(key)) return;
  flight.physics_line = table.line(key);
  const auto physics = Rate::parse(fmt::format("{}", table.number(key)));
  if (!physics) return table.error(key, physics.error().message);
  flight.physics = *physics;
  if (!rates.empty() && *physics < rates.back().motor_unit) {
    table.error(key, fmt::format("physics at {} Hz is slower than the loop at {} Hz; raise it, "
                                 "leave it out, or set `rates_hz` to lower rates",
                                 physics->to_string(), rates.back().motor_unit.to_string()));
  }
}

Vector3 parse_vector(const TomlTable& table, const std::string& key) {
  if (!table.has(key)) return {};
  const std::vector<double> numbers = table.numbers(key);
  if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
  table.error(key, "needs three numbers");
  return {};
}

FlightStart parse_start(const TomlTable& flight) {
  FlightStart start;
  if (!flight.has("start")) return start;
  const TomlTable table = flight.table("start");
  const auto [by, keys] = angle_keys(table);
  start.attitude = attitude_from(
      by, {table.number(keys[0], 0), table.number(keys[1], 0), table.number(keys[2], 0)});
  start.rate_rad_s = parse_vector(table, "rate_rad_s");
  start.height_m = table.number("height_m", 0);
  start.on_floor = table.boolean("on_floor", false);
  if (start.on_floor && table.has("height_m")) {
    table.error("height_m", "`on_floor` is given too; keep one");
  }
  if (start.on_floor && !flight.boolean("floor", false)) {
    table.error("on_floor", "needs `floor = true` in [flight]");
  }
  start.rotors_stopped = table.boolean("rotors_stopped", false);
  return start;
}

Estimator parse_estimator(const TomlTable& flight) {
  Estimator estimator;
  if (!flight.has("estimator")) return estimator;
  const TomlTable table = flight.table("estimator");
  estimator.delay = parse_optional_span(table, "delay").value_or(estimator.delay);
  if (table.has("drift")) {
    estimator.drift = table.number("drift");
    if (!(std::abs(*estimator.drift) < 1)) {
      table.error("drift", "is a fraction of the loop rate: between -1 (slower) and 1 (faster)");
    }
  }
  estimator.attitude_noise_deg = table.number("attitude_noise_deg", 0);
  estimator.rate_noise_rad_s = table.number("rate_noise_rad_s", 0);
  estimator.seed = static_cast<std::uint64_t>(table.integer("seed", 1));
  if (!(estimator.attitude_noise_deg >= 0)) table.error("attitude_noise_deg", "is negative");
  if (!(estimator.rate_noise_rad_s >= 0)) table.error("rate_noise_rad_s", "is negative");
  return estimator;
}

// With [flight.battery] the flight computes battery_status, so the case must not script it.
void parse_battery(const TomlTable& root, const TomlTable& flight, Case& parsed) {
  if (!flight.has("battery")) return;
  const TomlTable table = flight.table("battery");
  BatteryFlight battery;
  battery.charge = table.number("charge", battery.charge);
  if (!(battery.charge > 0 && battery.charge <= 1)) {
    table.error("charge", "is a part of the capacity: above 0, up to 1");
  }
  if (table.has("capacity_hover_s")) {
    battery.capacity_hover_s = table.number("capacity_hover_s");
    if (!(*battery.capacity_hover_s > 0)) table.error("capacity_hover_s", "must be positive");
  }
  battery.timing = parse_timing(table, battery.timing);
  if (root.has("battery_status")) {
    root.error("battery_status", "comes from [flight.battery]; remove one of the two");
  }
  std::erase_if(parsed.topics,
                [](const TopicStimulus& topic) { return topic.topic == "battery_status"; });
  parsed.flight->battery = battery;
}

std::array<Signal, 3> parse_signals(const TomlTable& flight, const std::string& key,
                                    const std::array<const char*, 3>& components) {
  std::array<Signal, 3> signals{};
  if (!flight.has(key)) return signals;
  const TomlTable table = flight.table(key);
  for (std::size_t i = 0; i < 3; ++i) {
    if (table.has(components[i])) signals[i] = parse_signal(table, components[i]);
  }
  return signals;
}

std::optional<MotorFailure> parse_motor_failure(const TomlTable& flight) {
  if (!flight.has("motor_failure")) return std::nullopt;
  const TomlTable table = flight.table("motor_failure");
  const std::int64_t rotor = table.integer("rotor");
  if (rotor < 0 || rotor >= static_cast<std::int64_t>(rotors_max)) {
    table.error("rotor", fmt::format("must be from 0 to {}", rotors_max - 1));
    return std::nullopt;
  }
  return MotorFailure{static_cast<std::size_t>(rotor), parse_span(table, "at")};
}

Window parse_window(const TomlTable& table) {
  const Window window{table.number("from_s", 0), table.number("to_s", Window{}.to_s)};
  if (!(window.from_s < window.to_s)) table.error("to_s", "must be after `from_s`");
  return window;
}

Metric parse_metric(const TomlTable& table, const std::string& name) {
  Metric metric;
  metric.name = name;
  const auto measure = parse_measure(table.text("measure"));
  if (!measure && table.has("measure")) table.error("measure", measure.error().message);
  if (measure) metric.measure = *measure;
  metric.window = parse_window(table);
  metric.band_deg = table.number("band_deg", metric.band_deg);
  if (!(metric.band_deg > 0)) table.error("band_deg", "must be positive");
  if (table.has("versus")) metric.versus = parse_window(table.table("versus"));
  metric.min = table.number("min", metric.min);
  metric.max = table.number("max", metric.max);
  if (!table.has("min") && !table.has("max")) {
    table.error("", "needs `min` or `max`: every flight would pass a metric without a bound");
  }
  return metric;
}

void parse_metrics(const TomlTable& flight, std::vector<Metric>& metrics) {
  const TomlTable table = flight.table("metrics");  // required: metrics judge a flight
  for (const std::string& name : table.keys()) {
    metrics.push_back(parse_metric(table.table(name), name));
  }
  if (metrics.empty() && flight.has("metrics")) flight.error("metrics", "names no metric");
}

RealtimeBudget parse_realtime(const TomlTable& flight) {
  RealtimeBudget budget;
  if (!flight.has("realtime")) return budget;
  const TomlTable table = flight.table("realtime");
  budget.misses_per_million = table.number("misses_per_million", budget.misses_per_million);
  budget.p99_latency_us = table.number("p99_latency_us", budget.p99_latency_us);
  if (!(budget.misses_per_million >= 0)) table.error("misses_per_million", "is negative");
  if (!(budget.p99_latency_us > 0)) table.error("p99_latency_us", "must be positive");
  if (table.has("execution_us")) {
    budget.execution_us = table.number("execution_us");
    if (!(*budget.execution_us > 0)) table.error("execution_us", "must be positive");
  }
  return budget;
}

}  // namespace

void parse_flight(const TomlTable& root, const std::filesystem::path& models, Case& parsed) {
  const TomlTable table = root.table("flight");
  const std::vector<std::string> known = vehicle_names(models);
  if (known.empty()) {
    return root.error("flight",
                      fmt::format("needs vehicles, and there are none in {}", models.string()));
  }
  Flight& flight = parsed.flight.emplace();
  parse_plant_configurations(table, known, flight);
  flight.other_rates = parse_other_rates(table, parsed);
  parse_physics(table, parsed.rates, flight);
  flight.floor = table.boolean("floor", false);
  flight.start = parse_start(table);
  flight.estimator = parse_estimator(table);
  if (parsed.attitude_loop) {
    parse_cascade_flight(root, table, parsed);
  } else if (table.has("motor_limits")) {
    flight.saturation = parse_timing(table.table("motor_limits"), flight.saturation);
  }
  flight.actuator_delay = parse_optional_span(table, "actuator_delay").value_or(Span{});
  parse_battery(root, table, parsed);
  flight.wind_m_s = parse_signals(table, "wind_m_s", {"north", "east", "down"});
  flight.centre_of_mass_of_arm =
      parse_signals(table, "centre_of_mass_of_arm", {"forward", "right", "down"});
  flight.motor_failure = parse_motor_failure(table);
  parse_metrics(table, flight.metrics);
  flight.realtime = parse_realtime(table);
  const bool needs_contact =
      flight.floor &&
      std::any_of(flight.plant_configurations.begin(), flight.plant_configurations.end(),
                  [](const PlantConfiguration& plant_configuration) {
                    return !has_floor(plant_configuration.plant);
                  });
  if (needs_contact) {
    table.error("floor", "needs `plants = [\"mujoco\"]`: the ode plant has no ground contact");
  }
}

}  // namespace attest
