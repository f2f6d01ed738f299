#include "harness/realtime/cyclictest.hpp"

#include <map>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/realtime/program.hpp"

namespace attest {

std::optional<Cyclictest> parse_cyclictest(const std::string& text) {
  // The histogram as text comes after it.
  const std::string first = text.substr(0, text.find("\n}") + 2);
  const auto json = nlohmann::json::parse(first, nullptr, false);
  const auto path = nlohmann::json::json_pointer("/thread/0");
  if (!json.is_object() || !json.contains(path)) return std::nullopt;
  const auto& thread = json[path];
  if (!thread.contains("histogram") || !thread["histogram"].is_object()) return std::nullopt;
  std::map<std::int64_t, std::int64_t> counts;
  std::int64_t all = 0;
  for (const auto& [us, count] : thread["histogram"].items()) {
    counts[std::stoll(us)] = count.get<std::int64_t>();
    all += count.get<std::int64_t>();
  }
  Cyclictest result;
  result.cycles = all;
  result.max = std::chrono::microseconds(thread.value("max", std::int64_t{0}));
  double before = 0;
  const double half = static_cast<double>(all) / 2;
  for (const auto& [us, count] : counts) {
    const auto here = static_cast<double>(count);
    if (before + here >= half) {
      const double within = (half - before) / here;
      result.median = Nanoseconds(us * 1000 + static_cast<std::int64_t>(within * 1000));
      return result;
    }
    before += here;
  }
  return std::nullopt;
}

std::optional<Cyclictest> run_cyclictest(const Rate& rate, Nanoseconds duration,
                                         const LiveOptions& options) {
  if (!is_installed("cyclictest")) return std::nullopt;
  const auto period_us = static_cast<std::int64_t>(rate.period_s() * 1e6);
  const std::string cpu = fmt::to_string(options.unit_cpu);
  std::vector<std::string> command = {"cyclictest",
                                      "-q",
                                      "-m",
                                      "-t1",
                                      "-a",
                                      cpu,
                                      "-i",
                                      fmt::to_string(period_us),
                                      "-l",
                                      fmt::to_string(rate.ticks_in(duration)),
                                      "-h",
                                      "10000",
                                      "--json=/dev/stdout"};
  if (options.fifo) {
    command.insert(command.end(), {"-p", "80"});
  } else {
    command.insert(command.end(), {"--policy=other"});
  }
  const auto json = output_of(command);
  return json ? parse_cyclictest(*json) : std::nullopt;
}

}  // namespace attest
