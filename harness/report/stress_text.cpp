#include "harness/report/stress_text.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/core/version.hpp"
#include "harness/measure/stress_json.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

// "-" for a percentile that is left out because it has too few samples beyond it.
std::string percentile(const std::optional<Nanoseconds>& time) {
  return time ? human_time(*time) : "-";
}

std::string row(std::string_view name, const Percentiles& spread) {
  if (spread.count == 0) return "";
  return fmt::format("  {:<22}{:>10}{:>10}{:>10}{:>10}{:>10}\n", name, percentile(spread.median),
                     percentile(spread.p90), percentile(spread.p99), percentile(spread.p999),
                     human_time(spread.max));
}

std::string cyclictest_row(const StressResult& stress) {
  if (!stress.cyclictest) return "";
  const auto theirs = static_cast<double>(stress.cyclictest->median.count());
  std::string out =
      fmt::format("  {:<22}{:>10}{:>40}", "cyclictest, idle", human_time(stress.cyclictest->median),
                  human_time(stress.cyclictest->max));
  if (const auto& ours = stress.idle.median) {
    const double ratio = static_cast<double>(ours->count()) / theirs;
    out += fmt::format("   idle machine: {:.2f} times this median", ratio);
  }
  return out + "\n";
}

double share(Nanoseconds part, Nanoseconds whole) {
  return whole.count() == 0
             ? 0
             : 100 * static_cast<double>(part.count()) / static_cast<double>(whole.count());
}

std::string counts(const StressResult& stress) {
  const DeadlineMisses& misses = stress.misses;
  std::string out = fmt::format(
      "  {} deadlines, {} missed ({:.0f} per million): {} late responses, {} skipped releases; {} "
      "of them by the port's execution time; {} overruns; longest gap {}\n",
      stress.deadlines, misses.total(), stress.per_million(misses.total()), misses.late,
      misses.skipped, misses.by_port, stress.overruns, human_time(stress.longest_gap));
  const Usage& unit = stress.unit_usage;
  out += fmt::format(
      "  unit: {:.1f}% CPU, {} waits, {} preemptions, {} page faults, {} allocations; plant: "
      "{:.1f}% CPU, {} of {} steps too late\n",
      share(unit.cpu, stress.wall), unit.yields, unit.preemptions, unit.page_faults,
      unit.allocations, share(stress.plant_usage.cpu, stress.wall), stress.plant_late_steps,
      stress.plant_steps);
  return out;
}

std::string slow_steps(const SlowTicks& slow) {
  if (slow.count == 0) return "";
  std::vector<std::string> worst;
  for (const auto& [tick, execution, elapsed] : slow.worst) {
    worst.push_back(fmt::format("tick {} ({})", tick, human_time(execution)));
  }
  std::string out = fmt::format("  slow steps: {} over {} of execution time: {}\n", slow.count,
                                human_time(slow.threshold), fmt::join(worst, ", "));
  if (const auto& rhythm = slow.rhythm) {
    out += fmt::format("  they come every {} steps, from tick {} on (chance: below {:.1g})\n",
                       rhythm->every, rhythm->first, std::max(rhythm->chance, 1e-12));
  }
  return out;
}

std::string_view title_of(const StressResult& stress) { return info_of(*stress.module).title; }

// The result of the rate unit comes before that of the attitude unit of the same flight.
bool is_of_same_flight(const StressResult& before, const StressResult& next) {
  return before.module == Module::rate_unit && next.module == Module::attitude_unit &&
         before.result.rate == next.result.rate;
}

int gravity(Verdict verdict) { return fails_a_run(verdict) ? 2 : verdict == Verdict::pass ? 0 : 1; }

std::string reason_of(const StressResult& stress) {
  const std::string& reason = stress.result.reason;
  return stress.module && !reason.empty() ? fmt::format("{}: {}", title_of(stress), reason)
                                          : reason;
}

// Adds the result of a unit to `all`, the result of the flight so far.
void add_unit(const StressResult& unit, VectorResult& all) {
  const std::string before = all.reason, reason = reason_of(unit);
  if (gravity(unit.result.verdict) > gravity(all.verdict)) all = unit.result;
  all.reason = fmt::format("{}{}{}", before, before.empty() || reason.empty() ? "" : "; ", reason);
}

std::string outputs(const VectorResult& result) {
  if (result.deviating_ticks == 0 && !result.first) {
    return result.tightest ? fmt::format(
                                 "  outputs agree with the reference's for the same inputs "
                                 "and times, headroom {:.3g}\n",
                                 result.tightest->ratio)
                           : "  outputs equal the reference's for the same inputs and times\n";
  }
  return finding_text(result, Level::numeric);
}

}  // namespace

std::string human_time(Nanoseconds time) {
  const auto ns = static_cast<double>(time.count());
  if (ns < 1e3) return fmt::format("{:g} ns", ns);
  if (ns < 1e6) return fmt::format("{:.3g} us", ns / 1e3);
  if (ns < 1e9) return fmt::format("{:.3g} ms", ns / 1e6);
  return fmt::format("{:.3g} s", ns / 1e9);
}

std::string render_stress(const StressResult& stress, TerminalStyle style) {
  const VectorResult& result = stress.result;
  const std::string of_unit = stress.module ? fmt::format(", {}", title_of(stress)) : "";
  std::string out = painted(one_line(result.id()) + of_unit, Colour::bold, style) + "\n";
  if (stress.ticks > 0) {
    out += fmt::format("  {:<22}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "median", "p90", "p99",
                       "p99.9", "max");
    out += cyclictest_row(stress);
    out += row("idle machine", stress.idle);
    out += row("wake-up latency", stress.latency);
    out += row("execution time", stress.execution);
    out += row("response time", stress.response);
    out += row("sample age", stress.age);
    out += row("plant's wake-up", stress.plant);
    out += counts(stress) + slow_steps(stress.slow) + outputs(result);
  }
  const bool failed = fails_a_run(result.verdict);
  const Colour colour = result.verdict == Verdict::pass ? Colour::green
                        : failed                        ? Colour::red
                                                        : Colour::yellow;
  out += "  " + painted(name_of(result.verdict), colour, style);
  if (!result.reason.empty()) out += ": " + one_line(result.reason);
  return out + "\n";
}

std::string render_privileges(const std::vector<RealtimePrivilege>& privileges) {
  std::vector<std::string> got, refused;
  for (const auto& [name, has, why] : privileges) {
    (has ? got : refused).push_back(has ? name : fmt::format("{} ({})", name, why));
  }
  std::string out =
      fmt::format("granted: {}\n", got.empty() ? "none" : fmt::to_string(fmt::join(got, ", ")));
  if (!refused.empty()) out += fmt::format("refused: {}\n", fmt::join(refused, ", "));
  return out;
}

std::vector<std::string> rates_not_judged(const StressRun& run) {
  std::vector<std::string> rates;
  for (const VectorResult& result : run_of(run).results) {
    if (!is_judged(result.verdict)) rates.push_back(result.rate.to_string());
  }
  return rates;
}

std::string_view verdict_of(const StressRun& run) {
  const RunResult all = run_of(run);
  if (all.failed()) return "fail";
  if (all.count(Verdict::pass) == 0) return "none";
  const bool complete = all.count(Verdict::pass) == all.results.size() && !run.interrupted;
  return complete ? "pass" : "partial";
}

std::string render_stress_end(const StressRun& run, TerminalStyle style) {
  const std::string_view verdict = verdict_of(run);
  const Colour colour = verdict == "pass"   ? Colour::green
                        : verdict == "fail" ? Colour::red
                                            : Colour::yellow;
  std::string word(verdict);
  for (char& letter : word) letter = static_cast<char>(std::toupper(letter));
  std::string out = painted(word, colour, style);
  const RunResult all = run_of(run);
  out += fmt::format(" {} of {} hold in real time (load: {})", all.count(Verdict::pass),
                     counted(all.results.size(), "rate"), run.load);
  if (const auto rates = rates_not_judged(run); !rates.empty()) {
    out += fmt::format("; not judged: {} Hz", fmt::join(rates, " Hz, "));
  }
  if (run.interrupted) out += "; interrupted";
  return out + "\n";
}

std::string rate_of(const StressResult& stress) {
  const std::string rate = stress.result.rate.to_string();
  return stress.module ? fmt::format("{}, {}", rate, title_of(stress)) : rate;
}

std::string note_on_units(const StressRun& run) {
  for (const StressResult& stress : run.results) {
    if (!stress.module) continue;
    const Module other =
        *stress.module == Module::rate_unit ? Module::attitude_unit : Module::rate_unit;
    if (contains(run.description.modules, other)) return "";
    return fmt::format("the {} is that of the reference, because the port has none: not judged",
                       info_of(other).title);
  }
  return "";
}

RunResult run_of(const StressRun& run) {
  RunResult all;
  all.attest_version = version;
  all.suite_folder = run.suite_folder;
  all.port = run.port;
  all.port_name = run.description.name;
  all.port_version = run.description.version;
  all.fraction_bits = run.description.fraction_bits;
  all.fixed_step = run.description.fixed_step;
  all.command = "stress";
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    const StressResult& stress = run.results[i];
    if (i > 0 && is_of_same_flight(run.results[i - 1], stress)) {
      add_unit(stress, all.results.back());
      continue;
    }
    all.results.push_back(stress.result);
    all.case_files[stress.result.case_id()] = run.case_file;
    all.results.back().reason = reason_of(stress);
    all.rates.push_back(stress.result.rate);
  }
  all.stopped_early = run.interrupted;
  return all;
}

std::string stress_json(const StressRun& run) {
  nlohmann::ordered_json out = {{"schema", "attest-stress-1"},
                                {"attest_version", version},
                                {"port", run.port},
                                {"load", run.load},
                                {"unit_cpu", run.live.unit_cpu},
                                {"plant_cpu", run.live.plant_cpu},
                                {"policy", run.live.fifo ? "fifo" : "other"},
                                {"spin_ns", run.live.wait.spin.count()},
                                {"interrupted", run.interrupted},
                                {"verdict", verdict_of(run)},
                                {"rates_not_judged", rates_not_judged(run)},
                                {"results", nlohmann::json::array()}};
  for (const StressResult& stress : run.results) {
    out["results"].push_back(nlohmann::ordered_json(to_json(stress)));
  }
  return document_of(out);
}

}  // namespace attest
