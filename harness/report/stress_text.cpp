#include "harness/report/stress_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/core/version.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/text.hpp"
#include "harness/suite/stress_json.hpp"

namespace attest {
namespace {

std::string row(std::string_view name, const Spread& spread) {
  if (spread.count == 0) return "";
  return fmt::format("  {:<22}{:>10}{:>10}{:>10}{:>10}{:>10}\n", name, human_time(spread.median),
                     human_time(spread.p90), human_time(spread.p99), human_time(spread.p999),
                     human_time(spread.max));
}

std::string cyclictest_row(const StressResult& stress) {
  if (!stress.cyclictest) return "";
  const auto ours = static_cast<double>(stress.idle.median.count());
  const auto theirs = static_cast<double>(stress.cyclictest->median.count());
  return fmt::format("  {:<22}{:>10}{:>40}   idle median {:.2f}x its\n", "cyclictest, idle",
                     human_time(stress.cyclictest->median), human_time(stress.cyclictest->max),
                     ours / theirs);
}

double share(Nanoseconds part, Nanoseconds whole) {
  return whole.count() == 0
             ? 0
             : 100 * static_cast<double>(part.count()) / static_cast<double>(whole.count());
}

std::string counts(const StressResult& stress) {
  std::string out = fmt::format(
      "  {} of {} deadlines kept, {} missed ({:.0f} per million), {} of them by long steps; {} "
      "overruns; longest gap {}\n",
      stress.ticks, stress.deadlines, stress.missed, stress.per_million(stress.missed),
      stress.missed_by_steps, stress.overruns, human_time(stress.longest_gap));
  const Usage& unit = stress.unit_usage;
  out += fmt::format(
      "  unit: {:.1f}% CPU, {} waits, {} preemptions, {} page faults, {} allocations; plant: "
      "{:.1f}% "
      "CPU, {} of {} steps too late\n",
      share(unit.cpu, stress.wall), unit.yields, unit.preemptions, unit.page_faults,
      unit.allocations, share(stress.plant_usage.cpu, stress.wall), stress.plant_late_steps,
      stress.plant_steps);
  return out;
}

std::string slow_steps(const SlowTicks& slow) {
  if (slow.count == 0) return "";
  std::vector<std::string> worst;
  for (const auto& [tick, execution, cpu] : slow.worst) {
    const std::string of = cpu < execution / 2 ? ", CPU " + human_time(cpu) : "";
    worst.push_back(fmt::format("tick {} ({}{})", tick, human_time(execution), of));
  }
  std::string out = fmt::format("  slow steps: {} over {}: {}\n", slow.count,
                                human_time(slow.threshold), fmt::join(worst, ", "));
  if (slow.every) {
    out += fmt::format("  they come every {} ticks, from tick {} on: that is the port's\n",
                       *slow.every, slow.first_regular);
  }
  return out;
}

std::string outputs(const CaseResult& result) {
  if (result.deviating_ticks == 0 && !result.first) {
    return result.tightest ? fmt::format(
                                 "  outputs agree with the reference's for the same inputs "
                                 "and times, headroom {:.3g}\n",
                                 result.tightest->ratio)
                           : "  outputs are the reference's for the same inputs and times\n";
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
  const CaseResult& result = stress.result;
  std::string out = painted(one_line(result.id()), Colour::bold, style) + "\n";
  if (stress.ticks > 0) {
    out += fmt::format("  {:<22}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "median", "p90", "p99",
                       "p99.9", "max");
    out += cyclictest_row(stress);
    out += row("idle machine", stress.idle);
    out += row("wake-up lateness", stress.lateness);
    out += row("execution of a step", stress.execution);
    out += row("age of the sample", stress.age);
    out += row("plant's lateness", stress.plant);
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

std::string render_rights(const std::vector<Right>& rights) {
  std::vector<std::string> got, refused;
  for (const auto& [name, has, why] : rights) {
    (has ? got : refused).push_back(has ? name : fmt::format("{} ({})", name, why));
  }
  std::string out =
      fmt::format("got: {}\n", got.empty() ? "nothing" : fmt::to_string(fmt::join(got, ", ")));
  if (!refused.empty()) out += fmt::format("refused: {}\n", fmt::join(refused, ", "));
  return out;
}

std::string render_stress_end(const StressRun& run, TerminalStyle style) {
  const RunResult all = run_of(run);
  const std::size_t passed = all.count(Verdict::pass);
  const std::size_t apart = all.count(Verdict::skip) + all.count(Verdict::unsupported);
  const std::size_t judged = all.results.size() - apart;
  const bool good = !all.failed() && passed > 0;
  const Colour colour = good ? Colour::green : all.failed() ? Colour::red : Colour::yellow;
  std::string out = painted(good ? "PASS" : all.failed() ? "FAIL" : "NONE", colour, style);
  out += fmt::format(" {} of {} hold in real time (load: {})", passed, counted(judged, "rate"),
                     run.load);
  if (apart > 0) out += fmt::format("; {} not judged", apart);
  if (run.interrupted) out += "; interrupted";
  return out + "\n";
}

RunResult run_of(const StressRun& run) {
  RunResult all;
  all.attest_version = version;
  all.port = run.port;
  all.port_name = run.description.name;
  all.port_version = run.description.version;
  all.fraction_bits = run.description.fraction_bits;
  all.fixed_step = run.description.fixed_step;
  all.command = "stress";
  for (const StressResult& stress : run.results) {
    all.results.push_back(stress.result);
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
                                {"results", nlohmann::json::array()}};
  for (const StressResult& stress : run.results) {
    out["results"].push_back(nlohmann::ordered_json(to_json(stress)));
  }
  return out.dump(2) + "\n";
}

}  // namespace attest
