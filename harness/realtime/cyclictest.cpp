#include "harness/realtime/cyclictest.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/process/program.hpp"

namespace attest {

namespace {

// Larger values are not plausible: a day, and a trillion cycles.
constexpr std::int64_t longest_us = 86'400'000'000;
constexpr std::int64_t most_cycles = 1'000'000'000'000;
// For the start of cyclictest, and for its output.
constexpr double patience_s = 10;

// The counts of cyclictest's histogram, by time [us]. Empty for other JSON.
std::optional<std::map<std::int64_t, std::int64_t>> counts_of(const nlohmann::json& histogram) {
  std::map<std::int64_t, std::int64_t> counts;
  if (!histogram.is_object()) return std::nullopt;
  for (const auto& [text, count] : histogram.items()) {
    std::int64_t us = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, us);
    const bool is_time = error == std::errc{} && rest == end && us >= 0 && us <= longest_us;
    if (!is_time || !count.is_number_unsigned() || count > most_cycles) return std::nullopt;
    counts[us] = count.get<std::int64_t>();
  }
  return counts;
}

}  // namespace

std::optional<Cyclictest> parse_cyclictest(const std::string& text) {
  // cyclictest prints the histogram again after the JSON, as text.
  const std::size_t end = std::min(text.find("\n}"), text.size());
  const auto json = json_from(text.substr(0, end + 2));
  const auto path = nlohmann::json::json_pointer("/thread/0");
  if (!json.is_object() || !json.contains(path) || !json[path].is_object()) return std::nullopt;
  const auto& thread = json[path];
  if (!thread.contains("histogram") || !thread.contains("max")) return std::nullopt;
  const auto& max = thread["max"];
  const auto counts = counts_of(thread["histogram"]);
  if (!counts || !max.is_number_unsigned() || max > longest_us) return std::nullopt;
  Cyclictest result;
  result.max = std::chrono::microseconds(max.get<std::int64_t>());
  for (const auto& [us, count] : *counts) result.cycles += count;
  double before = 0;
  const double half = static_cast<double>(result.cycles) / 2;
  for (const auto& [us, count] : *counts) {
    const auto here = static_cast<double>(count);
    if (here > 0 && before + here >= half) {
      const double within = (half - before) / here;
      result.median = Nanoseconds(us * 1000 + static_cast<std::int64_t>(within * 1000));
      return result;
    }
    before += here;
  }
  return std::nullopt;
}

std::optional<Cyclictest> run_cyclictest(const Rate& rate, Nanoseconds duration,
                                         const LiveOptions& options,
                                         const std::function<bool()>& stop) {
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
  const double duration_s = in_seconds(duration);
  const auto json = output_of(command, {duration_s + patience_s, stop});
  return json ? parse_cyclictest(*json) : std::nullopt;
}

}  // namespace attest
