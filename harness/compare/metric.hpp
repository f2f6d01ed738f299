// Metrics judge a flight as a whole: each is one number, over a window of the flight. Two correct
// controllers differ in the last bits. A flight may amplify this difference, but metrics stay
// nearly the same.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Attitude error: the angle of the rotation from the true attitude to q_d. Attitudes and rates are
// true ones (Trace::plant), not estimates.
enum class Measure {
  settling_time_s,         // from the window's start until the attitude error stays within the band
  overshoot_deg,           // largest attitude error after it was first within the band
  rms_attitude_error_deg,  // over all ticks of the window
  rms_rate_error_rad_s,    // of the three axes together, against the rates setpoint in force
  peak_rate_rad_s,         // largest |body rate|
  saturation_duty,         // fraction of the ticks with the mixer or allocator in saturation, 0..1
  peak_integral,           // largest |integral| of the three axes
  sink_m,                  // descent from the first tick of the window to the last
};

std::string_view name_of(Measure measure);
std::string_view unit_of(Measure measure);             // "rad/s"; may be empty
Result<Measure> parse_measure(std::string_view name);  // the error lists the known ones

// A part of the flight: times since the first tick [s].
struct Window {
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
};

struct Metric {
  std::string name;  // its key in the case: "settles"
  Measure measure = Measure::settling_time_s;
  Window window;
  double band_deg = 2;           // settling and overshoot: attitude error that counts as arrived
  std::optional<Window> versus;  // the value is divided by the value in this window
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

// The attitude setpoint in force at each tick of `flown`. `attitude` as for measured().
std::vector<std::array<float, 4>> attitude_setpoints(const Trace& flown, const Trace* attitude);

// The attitude error [deg] at each tick. `attitude` as for measured().
std::vector<double> attitude_errors_deg(const Trace& flown, const Trace* attitude);

// Infinite: a settling time if the error does not stay within the band; an overshoot if the error
// is never within the band. NaN: the window has no tick, `attitude` has no tick, or a measured
// value is NaN. `flown` is the trace of the unit that commands the motors. `attitude`: in a flight
// of the cascade the trace of its attitude unit, which has the attitude setpoint; otherwise null.
// REQUIRES: flown traces.
double measured(const Metric& metric, const Trace& flown, const Trace* attitude = nullptr);

}  // namespace attest
