// A case as plain data: a situation that a controller must handle like the reference.
//
// parse.hpp reads it from cases/<profile>/<group>/<name>.toml (SCHEMA.md). stimulus.hpp computes
// from it the inputs of a unit at one loop rate. A file with several profiles is a case of each.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/casefile/flight.hpp"
#include "harness/casefile/run_configuration.hpp"
#include "harness/casefile/signal.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/core/loop_rate.hpp"

namespace attest {

// When the samples of a topic are published.
struct Publication {
  enum class When {
    automatic,  // every tick if a field varies or the topic has no bit; else once, at time 0
    every_tick,
    periodic,  // `period` or `rate`, from `phase` on
    at_times,
    never,
  };
  When when = When::automatic;
  std::optional<Rate> rate;  // periodic: used instead of `period` if it is set
  Span period;
  Span phase;
  std::vector<Span> times;
  // With any `when`: the unit sees a sample `delay` after its release.
  Span delay{0, Span::In::seconds};
  // Only periodic: releases are late by up to this fraction of a period, and `drops` are left out.
  double jitter = 0;
  std::uint64_t seed = 1;
  std::vector<std::int64_t> drops;  // indices of releases, from 0
};

// A field follows `signal` instead of its own signal while `when` is not 0.
struct Replacement {
  Signal when;
  Signal signal;
};

struct FieldStimulus {
  std::size_t channel;  // index into channels(), an input
  Signal signal;
  bool of_hover = false;  // in a flight: in units of the vehicle's hover thrust
  double scale = 1;       // factor of the signal
  std::optional<Replacement> replacement = std::nullopt;
};

struct AttitudeStimulus {
  std::size_t channel;  // index of q[0] in channels(); q[1..3] follow
  AttitudeSignal attitude;
};

struct TopicStimulus {
  std::string topic;
  std::uint32_t updated_bit = 0;  // 0 for a topic without a bit, which is new at every tick
  Publication publication;
  std::vector<FieldStimulus> fields;
  std::vector<AttitudeStimulus> attitudes;
};

// A parameter and its value over time. At each tick where the value changes, it is sent with
// parameter_update.
struct ParameterStimulus {
  std::string name;
  Signal signal;
};

// Other work holds the processor for `length`, as in Stall (core/ticks.hpp).
struct UnitStall {
  Span every, length;
  bool catches_up = false;
};

// The unit's own ticks: late by jitter or stalls, or missing, as in TickSchedule
// (core/ticks.hpp).
struct UnitTiming {
  Span start{5.0, Span::In::seconds};  // timestamp at time 0 of the case
  double jitter = 0;
  bool heavy_tail = false;
  std::uint64_t seed = 1;
  std::vector<std::int64_t> drop_ticks;
  std::int64_t drop_every = 0;
  std::optional<UnitStall> stall;
  // Only in flights of the controller: these times are those of the estimator's samples, and a tick
  // begins when its sample arrives.
  bool on_estimate = false;
};

// The attitude unit of a flight of the cascade. The case itself is that of the rate unit, which
// commands the motors. Times in ticks are ticks of the attitude unit in `unit` and `delay`, and of
// the rate unit in `topics`.
struct AttitudeLoop {
  UnitTiming unit;
  std::vector<TopicStimulus> topics;
  Span delay{0, Span::In::seconds};  // of vehicle_rates_setpoint, on its way to the rate unit
};

struct ToleranceOverride {
  std::string channels;  // beginning of their names, without "out/"
  Tolerance tolerance;
};

// The lives of other instances of the port, relative to the judged instance. Many: each of them
// makes one step.
enum class Instances : std::uint8_t {
  one,
  again,           // one ran to its end and was destroyed before the judged one was made
  together,        // the judged one and another are stepped alternately, with different inputs
  crossed,         // one is made first; it runs and is destroyed before the judged one is stepped
  after_many,      // many were made and destroyed before the judged one was made
  among_many,      // many are made and destroyed, one after each step of the judged one
  other_profiles,  // the same, with other profiles; the first is made before the judged one
  two_threads,     // the judged one and another are stepped at the same time, on two threads
};

struct Case {
  std::filesystem::path file;
  std::string file_sha256;  // of the bytes of the file
  // Of what the file says, without its reasons and its profiles: inputs, rates, tolerances. A
  // golden with another hash is stale.
  std::string sha256;
  std::string profile;                // version of the law that this is a case of: "px4-v1.5.5"
  std::vector<std::string> profiles;  // of the file: that of its folder, the others newest first
  std::string group;
  std::string name;  // stem of the file
  std::string why;   // the mistake or property that it tests
  std::vector<LoopRate> rates;
  Span duration;
  UnitTiming unit;
  std::vector<ParameterStimulus> parameters;
  std::vector<TopicStimulus> topics;
  std::vector<ToleranceOverride> tolerances;
  std::string tolerance_why;
  // Compared at the exact level, skipped at the other levels: the case is on a threshold of the
  // law, where correct arithmetic may differ.
  bool exact_only = false;
  Instances instances = Instances::one;
  std::optional<Flight> flight;               // empty: open loop, every input is scripted
  std::optional<AttitudeLoop> attitude_loop;  // only in a flight of the cascade
  Module module = Module::mc_att_control;     // the module under test
  std::string mixer;                          // for Module::mixer: its definition

  // All run configurations. Open loop: one for each rate, ascending. A flight: ordered by plant
  // configuration, then by rate.
  std::vector<RunConfiguration> configurations() const;

  std::string id() const { return profile + "/" + group + "/" + name; }
  // The id of a vector in reports and filters: "px4-v1.5.5/flight/hover@250hz-iris-ode".
  std::string id_at(const RunConfiguration& configuration) const {
    return id() + "@" + configuration.label();
  }

  // The golden of the first profile has all columns, those of the other profiles only what differs
  // from it. The inputs and most outputs are the same in all profiles of a file.
  bool is_of_first_profile() const { return profiles.empty() || profile == profiles.front(); }

  // The values of a parameter over time, or the constant `otherwise` if the case does not set it.
  Signal parameter(std::string_view parameter_name, double otherwise) const;

  // The same case for another profile of its file.
  Case in_profile(const std::string& other) const;

  // The case of one unit of this flight: with the module, timing, topics and parameters of that
  // unit. REQUIRES: a unit of this flight.
  Case of_module(Module unit_of_flight) const;

  // The same case with its first timestamp at one period, so that the first dt is the period, too.
  // For ports with a fixed step.
  Case from_one_period_on() const;
};

// The tolerances of the level. At the numeric level, the case's own replace them where it has some,
// and a port in fixed point gets wider ones for a run of `ticks` ticks (Tolerances::allow_lsb).
Tolerances tolerances_of(const Case& the_case, Level level, std::optional<int> fraction_bits,
                         std::size_t ticks);

}  // namespace attest
