#include "harness/report/failure_text.hpp"

#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/host/port_process.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

// The shortest decimal that reads back as the same value.
std::string decimal(const Channel& channel, double value) {
  if (channel.type == ChannelType::f32) return fmt::format("{}", static_cast<float>(value));
  return fmt::format("{:.0f}", value);
}

std::string bits(double value) {
  return fmt::format("0x{:08x}", std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

std::string values(const Channel& channel, const Deviation& deviation) {
  const std::string got = decimal(channel, deviation.got);
  const std::string want = decimal(channel, deviation.want);
  if (channel.type != ChannelType::f32) {
    return fmt::format("    got   {}\n    want  {}\n", got, want);
  }
  const std::size_t width = std::max(got.size(), want.size());
  return fmt::format("    got   {:<{}}  {}\n    want  {:<{}}  {}\n", got, width,
                     bits(deviation.got), want, width, bits(deviation.want));
}

std::string times(double ratio) {
  if (ratio < 10) return fmt::format("{:.2f}", ratio);
  return ratio < 1e6 ? fmt::format("{:.0f}", ratio) : fmt::format("{:.0e}", ratio);
}

std::string indented_distance(const Deviation& deviation, Level level) {
  const std::string text = distance_text(deviation, level);
  return text.empty() ? text : fmt::format("    {}\n", text);
}

// Names the unit of the cascade: in a flight both units have ticks, and outputs of the same name.
std::string of_unit(const Channel& channel) {
  const ModuleInfo& module = info_of(channel.module);
  return module.is_of_cascade() ? fmt::format(", {}", module.title) : "";
}

std::string first_deviation(const Deviation& deviation, Level level) {
  const Channel& channel = channels()[deviation.channel];
  return fmt::format("  first at tick {}, timestamp {} us, in {}\n{}{}", deviation.tick,
                     deviation.timestamp_us, channel_with_unit(channel) + of_unit(channel),
                     values(channel, deviation), indented_distance(deviation, level));
}

std::string where_to_look(const Deviation& deviation) {
  if (stages_of(deviation) == only(Stage::input)) {
    return "  each output agrees with the reference's for the same inputs: small differences add "
           "up\n"
           "  in a flight; look first at failing vectors that are no flights\n";
  }
  return fmt::format(
      "  look first at the {}: no output of an earlier stage deviates up to this tick\n",
      stages_text(stages_of(deviation)));
}

// "attest", with --suite if it was given.
std::string attest_with_suite(const RunResult& run) {
  if (run.suite_folder.empty()) return "attest";
  return "attest --suite " + shell_word(run.suite_folder);
}

}  // namespace

std::string worst_text(const VectorResult& result) {
  if (!result.worst) return {};
  const Deviation& worst = *result.worst;
  if (result.first && result.first->tick == worst.tick && result.first->channel == worst.channel) {
    return {};
  }
  const double difference = std::abs(worst.got - worst.want);
  const std::string how_far = worst.tolerance > 0 ? fmt::format("{} times the tolerance",
                                                                times(difference / worst.tolerance))
                                                  : fmt::format("{} ulp", worst.ulp);
  return fmt::format("tick {}, in {}: off by {:.3g}, {}", worst.tick,
                     channel_with_unit(channels()[worst.channel]), difference, how_far);
}

std::string channel_with_unit(const Channel& channel) {
  const std::string_view unit = unit_of(channel.quantity);
  return unit.empty() ? std::string(channel.name) : fmt::format("{} [{}]", channel.name, unit);
}

std::string value_text(const Channel& channel, double value) {
  const std::string out = decimal(channel, value);
  return channel.type == ChannelType::f32 ? out + " " + bits(value) : out;
}

std::string distance_text(const Deviation& deviation, Level level) {
  if (channels()[deviation.channel].type != ChannelType::f32 || level == Level::events) return {};
  if (!std::isfinite(deviation.want)) return "the reference is not finite here, on purpose";
  if (!std::isfinite(deviation.got)) return "not a finite number where the reference has one";
  const double difference = std::abs(deviation.got - deviation.want);
  std::string out = fmt::format("off by {:.3g}", difference);
  if (deviation.ulp != 0) out += fmt::format(" ({} ulp)", deviation.ulp);
  if (level == Level::exact) return out + "; the exact level allows no other bits";
  out += fmt::format(", allowed {:.3g}", deviation.tolerance);
  if (deviation.tolerance == 0) return out;
  return out + fmt::format(": {} times the tolerance", times(difference / deviation.tolerance));
}

std::string reason_text(const VectorResult& result) {
  const std::string reason = one_line(result.reason);
  return reason.empty() ? std::string(meaning_of(result.verdict)) : reason;
}

std::string sim_command(const VectorResult& result, const RunResult& run) {
  return one_line(
      fmt::format("{} sim {} --rate {} --vehicle {} --plant {} --port {} "
                  "--out flown.csv --html flight.html",
                  attest_with_suite(run), shell_word(result.case_id()), result.rate.to_string(),
                  shell_word(result.plant_configuration->vehicle),
                  name_of(result.plant_configuration->plant), shell_word(run.port)));
}

std::string failure_headline(const VectorResult& result) {
  const std::string out = reason_text(result);
  if (!result.first) return out;
  const Deviation& deviation = *result.first;
  const Channel& channel = channels()[deviation.channel];
  return fmt::format("{}; first at tick {}: {} got {}, want {} ({})", out, deviation.tick,
                     channel.name, decimal(channel, deviation.got),
                     decimal(channel, deviation.want), stages_text(stages_of(deviation)));
}

std::string stages_text(const StageSet& stages) {
  if (stages == only(Stage::input)) return "flight as a whole";
  std::vector<std::string_view> names = names_of(stages);
  if (names.empty()) return {};
  const std::string_view last = names.back();
  names.pop_back();
  if (names.empty()) return std::string(last);
  return fmt::format("{} or the {}", fmt::join(names, ", the "), last);
}

std::string metric_bounds(const MetricResult& metric) {
  if (std::isinf(metric.min)) return fmt::format("at most {:g}", metric.max);
  if (std::isinf(metric.max)) return fmt::format("at least {:g}", metric.min);
  return fmt::format("{:g} to {:g}", metric.min, metric.max);
}

std::string reproduce_command(const VectorResult& result, const RunResult& run) {
  if (run.command == "stress") {
    return one_line(fmt::format("{} stress --port {} --case {} --rate {}", attest_with_suite(run),
                                shell_word(run.port), shell_word(result.case_id()),
                                result.rate.to_string()));
  }
  if (!run.timing.empty()) {
    return one_line(fmt::format("{} run --port {} --timing {}", attest_with_suite(run),
                                shell_word(run.port), shell_word(run.timing)));
  }
  std::string out = fmt::format("{} run --port {}", attest_with_suite(run), shell_word(run.port));
  for (const std::string& id : result.after) out += " --filter " + shell_quoted(id);
  out += " --filter " + shell_quoted(result.id());
  if (run.level != Level::numeric) out += fmt::format(" --level {}", name_of(run.level));
  for (const ParameterChange& change : run.parameters) {
    out += fmt::format(" --param {}={}", change.name, change.value);
  }
  const double timeout_s = run.limits.timeout_s;
  if (result.verdict == Verdict::timeout && timeout_s > 0 && timeout_s != default_timeout_s) {
    out += fmt::format(" --timeout {:g}", timeout_s);
  }
  return one_line(out);
}

std::string finding_text(const VectorResult& result, Level level, bool inputs_differ) {
  std::string out;
  if (result.first) out += first_deviation(*result.first, level);
  if (result.first && !inputs_differ) out += where_to_look(*result.first);
  if (const std::string worst = worst_text(result); !worst.empty()) {
    out += fmt::format("  worst at {}\n", worst);
  }
  if (result.deviating_ticks > 0) {
    out += fmt::format("  {} of {} deviate\n", result.deviating_ticks,
                       counted(result.ticks, result.plant_configuration ? "row" : "tick"));
  }
  return out;
}

std::string failure_text(const VectorResult& result, const RunResult& run) {
  std::string out = fmt::format("{}\n  {}: {}\n", one_line(result.id()), name_of(result.verdict),
                                reason_text(result));
  out += finding_text(result, run.level);
  const std::string id = result.case_id();
  if (const auto why = run.whys.find(id); why != run.whys.end() && !why->second.empty())
    out += fmt::format("  it tests:  {}\n", one_line(why->second));
  if (const auto file = run.case_files.find(id); file != run.case_files.end()) {
    // The folder is the first of the profiles that share the file.
    const bool is_own = file->second.find(result.profile + "/") != std::string::npos;
    out += fmt::format("  case:      {}{}\n", one_line(file->second),
                       is_own ? "" : fmt::format(" (also of {})", one_line(result.profile)));
  }
  const auto golden = run.golden_files.find(id);
  if (golden != run.golden_files.end() && result.first && run.command == "run" &&
      run.timing.empty()) {
    out += fmt::format("  golden:    {}\n", one_line(golden->second));
  }
  out += "  reproduce: " + reproduce_command(result, run);
  if (result.plant_configuration && run.timing.empty())
    out += "\n  fly it:    " + sim_command(result, run);
  const bool hides = result.verdict == Verdict::crash || result.verdict == Verdict::timeout;
  return hides ? out + "\n  debug:     the same with --in-process, under a debugger" : out;
}

}  // namespace attest
