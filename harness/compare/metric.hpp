// What a flight is judged by as a whole: one number each, over a window of its time. Two right
// controllers part in the last bits, and a flight may amplify that; a metric is what does not mind.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Attitude error: the angle of the rotation from the true attitude to q_d. All are of the truth
// (Trace::plant), not of the estimate.
enum class Measure {
  settling_time_s,         // from the window's begin until the attitude error stays within the band
  overshoot_deg,           // largest attitude error after it was first within the band
  rms_attitude_error_deg,  //
  rms_rate_error_rad_s,    // of the three axes together, against the rates setpoint in force
  peak_rate_rad_s,         // largest |body rate|
  saturation_duty,         // part of the ticks in which the mixer gave something up, 0..1
  peak_integral,           // largest |integral| of the three axes
  sink_m,                  // how far it went down
};

std::string_view name_of(Measure measure);
Result<Measure> parse_measure(std::string_view name);  // the error says which there are

// A stretch of time since the first tick [s].
struct Window {
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
};

struct Metric {
  std::string name;  // as the case calls it: "settles"
  Measure measure = Measure::settling_time_s;
  Window window;
  double band_deg = 2;           // settling and overshoot: what counts as having arrived
  std::optional<Window> versus;  // the value is divided by that of this window
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

// Infinite when it never settles; NaN when the window has no tick, or one with a NaN in what is
// measured. REQUIRES: a flown trace.
double measured(const Metric& metric, const Trace& flown);

}  // namespace attest
