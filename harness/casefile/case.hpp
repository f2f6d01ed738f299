// A case: a situation that a controller must handle like the reference, as plain data.
//
// Read from cases/<profile>/<group>/<behaviour>.toml (parse.hpp, SCHEMA.md), made into the inputs
// of a unit at one loop rate by stimulus.hpp. A file that names several profiles is a case of each.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/flight.hpp"
#include "harness/casefile/run_configuration.hpp"
#include "harness/casefile/signal.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

// When the samples of a topic are published.
struct Publication {
  enum class When {
    automatic,  // every tick if a field varies, else at the first tick
    every_tick,
    periodic,  // `period` or `rate`, from `phase` on
    at_times,
    never,
  };
  When when = When::automatic;
  std::optional<Rate> rate;  // periodic: this, or
  Span period;
  Span phase;
  std::vector<Span> times;
  // Of every kind: a sample is seen `delay` after its release.
  Span delay{0, Span::In::seconds};
  // periodic: late by up to this fraction of a period, and samples that are never released.
  double jitter = 0;
  std::uint64_t seed = 1;
  std::vector<std::int64_t> drops;
};

// What a field is in place of its signal while another signal is not 0.
struct Replacement {
  Signal when;
  Signal signal;
};

struct FieldStimulus {
  std::size_t channel;  // index into channels(), an input
  Signal signal;
  bool of_hover = false;  // a flight's: in units of the vehicle's hover thrust
  double scale = 1;       // what the signal is multiplied with
  std::optional<Replacement> replacement = std::nullopt;
};

struct AttitudeStimulus {
  std::size_t channel;  // of q[0]; q[1..3] follow
  AttitudeSignal attitude;
};

struct TopicStimulus {
  std::string topic;
  std::uint32_t updated_bit = 0;  // 0 for control_state, which is new at every tick
  Publication publication;
  std::vector<FieldStimulus> fields;
  std::vector<AttitudeStimulus> attitudes;
};

// A parameter and its value over time; a varying one is sent with parameter_update at the ticks
// where its value changes.
struct ParameterStimulus {
  std::string name;
  Signal signal;
};

// Something else holds the processor, as in Stall.
struct UnitStall {
  Span every, length;
  bool catches_up = false;
};

// The unit's own ticks: late by jitter or stalls, or missing, as in TickSchedule.
struct UnitTiming {
  Span start{5.0, Span::In::seconds};  // timestamp of the first tick
  double jitter = 0;
  bool heavy_tail = false;
  std::uint64_t seed = 1;
  std::vector<std::int64_t> drop_ticks;
  std::int64_t drop_every = 0;
  std::optional<UnitStall> stall;
  // Of a flight: these times are those of the estimator's samples, and a tick begins when its
  // sample arrives.
  bool on_estimate = false;
};

struct ToleranceOverride {
  std::string channels;  // prefix without "out/"
  Tolerance tolerance;
};

// Thresholds of the attitude law that a case stands on, where turning one way is as right as the
// other: at such a tick a port may answer what either branch does.
struct EitherBranch {
  bool yaw_wrap = false;          // a yaw error of 180 deg
  bool shorter_rotation = false;  // beyond 90 deg of tilt, a direct rotation of 180 deg

  bool any() const { return yaw_wrap || shorter_rotation; }
};

// How instances of the port come and go around the one that is judged.
enum class Instances : std::uint8_t {
  one,
  again,     // another one has run to its end and was destroyed
  together,  // another one is given other inputs, by turns with this one
  crossed,   // another one was made before this one, ran, and was destroyed after this was made
};

struct Case {
  std::filesystem::path file;
  std::string sha256;                 // of the file: a golden of another version of it is stale
  std::string profile;                // version of the law that this is a case of: "px4-v1.5.5"
  std::vector<std::string> profiles;  // of the file; the first is that of its folder
  std::string group;
  std::string name;  // stem of the file
  std::string why;   // which mistake or property it is there for
  std::vector<Rate> rates;
  Span duration;
  UnitTiming unit;
  std::vector<ParameterStimulus> parameters;
  std::vector<TopicStimulus> topics;
  std::vector<ToleranceOverride> tolerances;
  std::string tolerance_why;
  // On a threshold of the law, where correct arithmetic may differ: skipped at the numeric level.
  bool exact_only = false;
  // Where bits are the platform's (its exp and acos) and not the law's: never compared exactly.
  bool numeric_only = false;
  EitherBranch either_branch;
  Instances instances = Instances::one;
  std::optional<Flight> flight;            // empty: open loop, every input is scripted
  Module module = Module::mc_att_control;  // which is given the inputs
  std::string mixer;                       // of Module::mixer, its definition

  // Every way to run it: open loop one a rate, ascending; a flight by plant configuration, then
  // rate.
  std::vector<RunConfiguration> configurations() const;

  std::string id() const { return profile + "/" + group + "/" + name; }

  // The inputs and most answers are the same in all profiles of the file: the golden of the first
  // holds them, those of the others hold what differs.
  bool is_of_first_profile() const { return profiles.empty() || profile == profiles.front(); }

  // The same case of another profile of its file.
  Case in_profile(const std::string& other) const;

  // The same case with its first timestamp at one period: for a port with a fixed step, so that
  // each dt is the period.
  Case from_one_period_on() const;
};

}  // namespace attest
