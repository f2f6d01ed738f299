#include "harness/cli/log_cases.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/parse.hpp"
#include "harness/ulog/single_steps.hpp"

namespace attest::cli {
namespace {

constexpr double ticks_of_window = 250;
constexpr std::size_t most_windows = 100;

double seconds_of(const Trace& steps) {
  const std::uint64_t begin = steps.samples.front().in.timestamp;
  return static_cast<double>(steps.samples.back().in.timestamp - begin) * 1e-6;
}

// The rate of the suite that is nearest to that of the steps.
Rate rate_of(const Trace& steps) {
  const double hz = static_cast<double>(steps.samples.size() - 1) / seconds_of(steps);
  const auto distance = [&](const Rate& rate) { return distance_of(rate, hz); };
  std::vector<Rate> rates;
  for (const int rate_hz : info_of(module_of(steps.present)).default_rates_hz) {
    rates.push_back(Rate::hz(rate_hz));
  }
  return std::ranges::min(rates.empty() ? standard_rates() : rates, {}, distance);
}

std::vector<LogPart> parts_of(const Trace& steps, const Rate& rate) {
  const double length_s = seconds_of(steps), window_s = ticks_of_window * rate.period_s();
  if (length_s <= window_s) return {LogPart()};
  const auto needed = static_cast<std::size_t>(std::ceil(length_s / window_s));
  const std::size_t count = std::min(needed, most_windows);
  std::vector<LogPart> parts;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    // Whole milliseconds, for texts that can be read.
    const double from_s =
        std::floor(length_s * 1000 * static_cast<double>(i) / static_cast<double>(count)) / 1000;
    parts.push_back({from_s, from_s + window_s});
  }
  parts.push_back({length_s - window_s, LogPart().to_s});
  return parts;
}

Result<LogWindow> window_of(const Trace& steps, const LogPart& part, const Rate& rate,
                            const std::string& profile) {
  const auto made = case_of_log(steps, profile, part, {});
  if (!made) return tl::unexpected(made.error());
  auto parsed = parse_case_text(
      made->toml, fmt::format("cases/{}/{}/{}.toml", profile, log_case_group, made->name));
  if (!parsed) return tl::unexpected(parsed.error());
  return LogWindow{*std::move(parsed), rate};
}

}  // namespace

Result<Trace> steps_of(const LoggedUnit& unit, FlightLog& log) {
  Trace steps;
  if (unit.module == Module::mc_att_control || unit.not_judged.empty()) {
    steps = unit.trace;
  } else if (!unit.trace.samples.empty()) {
    const auto single = single_steps_of(unit);
    if (!single) return tl::unexpected(single.error());
    if (auto read = single->ticks->next_part(whole_trace, steps); !read) {
      return tl::unexpected(read.error());
    }
    log.notes.push_back(fmt::format("the {} has {} single steps, of {} that the log has outputs of",
                                    info_of(unit.module).title, steps.samples.size(),
                                    single->single_steps->logged));
  }
  if (steps.samples.size() < 2) {
    log.notes.push_back(
        fmt::format("no case of the {}: {}", info_of(unit.module).title, unit.not_judged));
  }
  return steps;
}

Result<std::vector<LogWindow>> windows_of(
    FlightLog& log, const std::string& file,
    const std::function<bool(const ModuleUnderTest&)>& is_wanted) {
  std::vector<LogWindow> windows;
  std::string why;
  for (const LoggedUnit& unit : log.units) {
    if (!is_wanted({log.profile, unit.module})) {
      why = fmt::format(
          "has the {} of {}, which this hunt does not have; choose others with --profile "
          "and --module",
          info_of(unit.module).title, log.profile);
      log.notes.push_back("is left out: " + why);
      continue;
    }
    const auto steps = steps_of(unit, log);
    if (!steps) return tl::unexpected(steps.error());
    if (steps->samples.size() < 2) {
      why = log.notes.back();
      continue;
    }
    const Rate rate = rate_of(*steps);
    for (const LogPart& part : parts_of(*steps, rate)) {
      auto window = window_of(*steps, part, rate, log.profile);
      if (window) {
        windows.push_back(*std::move(window));
      } else {
        why = window.error().message;  // a gap of the log
      }
    }
  }
  if (windows.empty()) return fail_at(file, why);
  return windows;
}

}  // namespace attest::cli
