#include "harness/ulog/flight_log.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/ulog/format.hpp"
#include "harness/ulog/left_out.hpp"
#include "harness/ulog/own_topics.hpp"
#include "harness/ulog/unit_log.hpp"

namespace attest {
namespace {

using ulog::LogContents;
using ulog::LogRules;
using ulog::LogSeries;
using ulog::ModuleContents;

constexpr const char* fastest_rate = "IMU_GYRO_RATEMAX";  // of the rate unit [Hz]

// The output topics of a module, for a message.
std::string outputs_of(Module module) {
  switch (module) {
    case Module::attitude_unit:
      return "vehicle_rates_setpoint";
    case Module::rate_unit:
      return "vehicle_torque_setpoint, vehicle_thrust_setpoint or rate_ctrl_status";
    default:
      return "vehicle_rates_setpoint or actuator_controls_0";
  }
}

bool is_optional(std::string_view field) {
  constexpr std::string_view optional[] = {"landing_gear", "disable_mc_yaw_control",
                                           "timestamp_published", "timestamp_sample",
                                           "quat_reset_counter"};
  return field.starts_with("delta_q_reset") ||
         std::find(std::begin(optional), std::end(optional), field) != std::end(optional);
}

// What the log lacks to replay a module; empty if it has enough.
std::string lacking(const ModuleContents& log, bool is_of_attest) {
  const LogSeries& steps = log.steps();
  if (steps.size() + steps.left_out() == 0) {
    return fmt::format("no sample of the topic {}", steps.name());
  }
  if (steps.left_out() > steps.size()) {
    return fmt::format("too few steps: {} of {} samples of the topic {} have no usable time",
                       steps.left_out(), steps.size() + steps.left_out(), steps.name());
  }
  if (is_of_attest) return "";
  const LogSeries& setpoint = *log.input(info_of(log.module()).setpoint_topic);
  if (setpoint.size() == 0) return fmt::format("no sample of the topic {}", setpoint.name());
  if (!log.has_outputs()) {
    return fmt::format("no sample of {}, so there is nothing to compare a port with",
                       outputs_of(log.module()));
  }
  for (const LogSeries* series : {&steps, &setpoint}) {
    for (const LogField* missing : series->missing_fields()) {
      if (is_optional(missing->name)) continue;
      return fmt::format("a topic {} without the field {}; is the log of another version of PX4?",
                         series->name(), missing->name);
    }
  }
  return "";
}

// The modules whose units the log may have recorded.
std::vector<ModuleContents*> candidates(LogContents& log) {
  ModuleContents& controller = log.of(Module::mc_att_control);
  ModuleContents& attitude = log.of(Module::attitude_unit);
  ModuleContents& rate = log.of(Module::rate_unit);
  if (controller.steps().size() > 0) return {&controller};
  // The rate unit comes first: in its flights, attest logs the true vehicle_attitude, too.
  if (log.is_of_attest() && rate.steps().size() > 0) return {&rate};
  if (log.is_of_attest() && attitude.steps().size() > 0) return {&attitude};
  return {&attitude, &rate};
}

// Why no unit of a log can be replayed.
std::string nothing_in(const std::vector<ModuleContents*>& modules, bool is_of_attest) {
  if (modules.size() == 1) return "has " + lacking(*modules.front(), is_of_attest);
  std::vector<std::string> reasons;
  for (const ModuleContents* log : modules) {
    reasons.push_back(
        fmt::format("for the {}: {}", info_of(log->module()).title, lacking(*log, is_of_attest)));
  }
  return fmt::format(
      "has too little to replay: for the controller of PX4 v1.5.5 and v1.3.4: no "
      "sample of the topic control_state; {}",
      fmt::join(reasons, "; "));
}

// The sample before the first step. A unit of v1.14 to v1.18 takes some flags as true before the
// first sample of their topic, so they are true here.
Sample first_sample(const ModuleContents& log, LogRules rules) {
  Sample sample;
  if (rules != LogRules::cascade) return sample;
  if (log.module() == Module::attitude_unit) {
    sample.attitude_in.vehicle_status.is_rotary_wing = 1;
    sample.attitude_in.vehicle_land_detected.landed = 1;
    sample.attitude_in.vehicle_local_position.heading_good_for_control = 1;
  } else {
    sample.rate_in.vehicle_status.is_rotary_wing = 1;
    sample.rate_in.vehicle_land_detected = {1, 1};
  }
  return sample;
}

std::optional<double> fastest_hz(const ModuleContents& log) {
  std::optional<double> found;
  for (const ParameterChange& change : log.parameters) {
    if (change.name == fastest_rate && change.value > 0) found = change.value;
  }
  return log.module() == Module::rate_unit ? found : std::nullopt;
}

void judge_steps(const StepGaps& gaps, std::optional<double> rate_hz, LoggedUnit& unit) {
  unit.not_judged = too_sparse(unit.module, gaps, rate_hz);
  unit.period_us = gaps.period_us;
  unit.has_every_step = unit.has_every_step && unit.not_judged.empty() &&
                        may_be_complete(unit.module, gaps, rate_hz) && !unit.begins_in_flight;
}

void add_missing(const LogSeries& series, std::vector<std::string>& notes) {
  std::vector<std::string> missing;
  for (const LogField* field : series.missing_fields()) {
    const std::string value = field->if_absent == 0 ? "" : fmt::format(" ({:g})", field->if_absent);
    missing.push_back(series.name() + "." + field->name + value);
  }
  if (missing.empty()) return;
  notes.push_back(fmt::format("not in the log, so {}: {}",
                              series.is_output() ? "not compared" : "0", fmt::join(missing, ", ")));
}

// Adds a note once, because several modules may have the same topic.
void add_once(std::string note, std::vector<std::string>& notes) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
}

void add_notes(const ModuleContents& log, std::vector<std::string>& notes) {
  for (const LogSeries& series : log.series()) {
    if (series.size() > 0) {
      std::vector<std::string> missing;
      add_missing(series, missing);
      for (std::string& note : missing) add_once(std::move(note), notes);
    }
  }
}

void add_left_out(const ModuleContents& log, ulog::LeftOutSamples& samples) {
  using ulog::LeftOutSamples;
  for (const LogSeries& series : log.series()) {
    samples.add(LeftOutSamples::absurd, series.name(), series.absurd());
    samples.add(LeftOutSamples::not_later, series.name(), series.left_out() - series.absurd());
    samples.add(LeftOutSamples::without_time, series.name(), series.without_time());
  }
}

void add_origin(const LogContents& log, std::vector<std::string>& notes) {
  if (log.system.empty()) return;
  const std::string release = log.release ? " " + log.release->to_string() : "";
  notes.push_back(fmt::format("logged by {}{}{}{}", log.system, release,
                              log.firmware.empty() ? "" : " " + log.firmware,
                              log.branch.empty() ? "" : ", branch " + log.branch));
}

void add_losses(const LogContents& log, std::vector<std::string>& notes) {
  if (log.dropouts > 0) {
    notes.push_back(log.dropouts == 1
                        ? "the logger lost messages once"
                        : fmt::format("the logger lost messages {} times", log.dropouts));
  }
  for (const std::string& damage : log.damage) notes.push_back("damaged: " + damage);
}

class TicksInMemory final : public LoggedTicks {
 public:
  explicit TicksInMemory(const LoggedUnit& unit) : unit_(unit), parts_(unit.trace) {
    parameters_ = unit.trace.parameters;
  }

  const std::string& file() const override { return unit_.trace.source; }
  const ChannelSet& present() const override { return unit_.trace.present; }
  Result<void> rewind() override {
    next_ = 0;
    return parts_.rewind();
  }
  Result<void> next_part(std::size_t most, Trace& part) override {
    auto read = parts_.next_part(most, part);
    const std::size_t ticks = part.samples.size();
    part.parameters = changes_in(parameters_, next_, ticks);
    const auto begin = unit_.setpoints.begin() + static_cast<std::ptrdiff_t>(next_);
    setpoints_.assign(begin, begin + static_cast<std::ptrdiff_t>(ticks));
    next_ += ticks;
    return read;
  }

 private:
  const LoggedUnit& unit_;
  PartsOfTrace parts_;
  std::size_t next_ = 0;
};

class LogReading {
 public:
  LogReading(const std::filesystem::path& path, LogContents& log,
             const std::vector<std::string>& assumed)
      : path_(path), log_(log), assumed_(assumed) {}

  Result<FlightLog> read() {
    const auto modules = candidates(log_);
    const auto is_lacking = [&](const ModuleContents* one) {
      return !lacking(*one, log_.is_of_attest()).empty();
    };
    if (!log_.has_data) {
      return fail_at(path_.string(),
                     "has no sample of any topic, as if it was cut off in its "
                     "definitions; copy the log again");
    }
    if (std::all_of(modules.begin(), modules.end(), is_lacking)) {
      flight_.too_little = nothing_in(modules, log_.is_of_attest());
    }
    const std::vector<const ModuleContents*> known(modules.begin(), modules.end());
    if (auto checked = check_assumed(assumed_, known); flight_.too_little.empty() && !checked) {
      return fail_at(path_.string(), checked.error().message);
    }
    flight_.is_of_attest = log_.is_of_attest();
    flight_.release = log_.release;
    flight_.branch = log_.branch;
    flight_.profile = log_.source.substr(0, std::min(log_.source.find('/'), log_.source.size()));
    add_origin(log_, flight_.notes);
    for (ModuleContents* module : modules) {
      if (auto added = add(*module); !added) return tl::unexpected(added.error());
    }
    for (std::string& note : left_out_.notes()) flight_.notes.push_back(std::move(note));
    note_assumed();
    add_losses(log_, flight_.notes);
    return std::move(flight_);
  }

 private:
  Result<void> add(ModuleContents& log) {
    if (std::string missing = lacking(log, log_.is_of_attest()); !missing.empty()) {
      LoggedUnit& unit = flight_.units.emplace_back();
      unit.module = log.module();
      unit.step_topic = log.steps().name();
      unit.trace.present.set(0).set(updated_channel(log.module(), "parameter_update"));
      unit.not_judged = "the log has " + std::move(missing);
      unit.trace.source = path_.string();
      return {};
    }
    auto unit = made(log);
    if (!unit) return tl::unexpected(unit.error());
    flight_.units.push_back(*std::move(unit));
    return {};
  }

  Result<LoggedUnit> made(ModuleContents& log) {
    const LogRules rules = log_.is_of_attest()                     ? LogRules::attest
                           : info_of(log.module()).is_of_cascade() ? LogRules::cascade
                                                                   : LogRules::controller;
    add_notes(log, flight_.notes);
    add_left_out(log, left_out_);
    Sample first = first_sample(log, rules);
    std::vector<std::string> used;
    if (!assumed_.empty() || rules != LogRules::attest) used = assume(assumed_, log, first);
    for (const std::string& word : used) add_once(word, used_);
    const auto rate_hz = fastest_hz(log);
    const StepGaps gaps = log.step_gaps(rate_hz);
    const bool is_sparse =
        rules == LogRules::cascade && !too_sparse(log.module(), gaps, rate_hz).empty();
    auto unit = unit_of_log(std::move(log), first, rules, is_sparse, path_.string());
    if (!unit) return unit;
    if (log_.dropouts > 0 || log_.may_lack_samples) unit->has_every_step = false;
    if (rules == LogRules::cascade && !used.empty()) unit->has_every_step = false;
    if (rules == LogRules::cascade) judge_steps(gaps, rate_hz, *unit);
    return unit;
  }

  void note_assumed() {
    if (used_.empty()) return;
    flight_.notes.push_back(fmt::format("assumed, because the log does not have it: {} (--assume)",
                                        fmt::join(used_, ", ")));
  }

  const std::filesystem::path& path_;
  LogContents& log_;
  const std::vector<std::string>& assumed_;
  std::vector<std::string> used_;  // words that had an effect
  ulog::LeftOutSamples left_out_;
  FlightLog flight_;
};

}  // namespace

Result<FlightLog> read_flight_log(const std::filesystem::path& path,
                                  const std::vector<std::string>& assumed, bool whole) {
  auto contents = ulog::read_contents(path);
  if (!contents) return tl::unexpected(contents.error());
  auto log = LogReading(path, *contents, assumed).read();
  if (!log || !whole) return log;
  for (LoggedUnit& unit : log->units) {
    if (!unit.ticks) continue;
    const auto ticks = std::exchange(unit.ticks, nullptr);
    auto read = ticks->next_part(std::numeric_limits<std::size_t>::max(), unit.trace);
    if (!read) return tl::unexpected(read.error());
    unit.setpoints = ticks->setpoints();
  }
  return log;
}

std::shared_ptr<LoggedTicks> ticks_of(const LoggedUnit& unit) {
  if (unit.ticks) return unit.ticks;
  return std::make_shared<TicksInMemory>(unit);
}

}  // namespace attest
