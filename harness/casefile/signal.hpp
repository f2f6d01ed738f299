// Signals: how one field of a topic changes over the time of a case.
//
// All arithmetic is double; a value is rounded once, when it is written into the ABI struct. Times
// count from the start of the case, in seconds or in ticks of the unit. With ticks, one case
// exercises the same steps at every loop rate.
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "harness/core/frames.hpp"
#include "harness/core/rate.hpp"
#include "harness/core/time.hpp"

namespace attest {

// The unit's loop rate and the duration of the case. They convert ticks and cycles to seconds.
struct Timeline {
  Rate rate = Rate::hz(250);
  Nanoseconds duration{0};
};

struct Span {
  enum class In { ticks, seconds };
  double amount = 0;
  In in = In::ticks;

  Nanoseconds on(const Rate& unit_rate) const;
};

// The number of ticks of the unit that begin in `duration`. REQUIRES: a whole number if it is in
// ticks.
std::int64_t tick_count(const Span& duration, const Rate& unit_rate);

struct Frequency {
  enum class In { hertz, cycles };  // cycles: over the whole case
  double amount = 0;
  In in = In::cycles;

  double hertz_on(const Timeline& timeline) const;
};

struct Constant {
  double value = 0;
};
struct Step {  // `from` before `at`, `to` from then on
  double from = 0, to = 0;
  Span at;
};
struct Ramp {  // straight from `from` at `start` to `to` at `end`, held outside
  double from = 0, to = 0;
  Span start, end;
};
struct Sine {  // mean + amplitude sin(2 pi f t + phase)
  double mean = 0, amplitude = 0, phase_deg = 0;
  Frequency frequency;
};
struct Chirp {  // a sine whose frequency goes linearly from `from` to `to` over the case
  double mean = 0, amplitude = 0;
  Frequency from, to;
};
struct RandomWalk {  // each `every` moves by a uniform number up to +-step, reflected at the bounds
  std::uint64_t seed = 1;
  double start = 0, step = 0, min = 0, max = 0;
  Span every;
};
struct Samples {  // values[i] from times[i] on; before the first time the first value
  std::vector<Span> times;
  std::vector<double> values;
  bool linear = false;  // straight lines between the samples, instead of holding
};

using Signal = std::variant<Constant, Step, Ramp, Sine, Chirp, RandomWalk, Samples>;

// The three angles [deg] that define an attitude q, body FRD to world NED.
enum class Angles {
  // q_tilt * q_yaw: q_yaw turns by the yaw about world down, and then q_tilt by the tilt about the
  // horizontal world axis at the azimuth from north (0: roll right of a vehicle that heads north,
  // 90: pitch up).
  tilt_azimuth_yaw,
  // q_yaw * q_pitch * q_roll, the aerospace sequence: the body turns by the yaw about its z, then
  // by the pitch about its new y, then by the roll about its new x.
  roll_pitch_yaw,
};

// An attitude given by its angles, each a signal of its own. The quaternion is multiplied by sign
// and norm.
struct AttitudeSignal {
  Angles by = Angles::tilt_azimuth_yaw;
  std::array<Signal, 3> angles_deg{};  // in the order of the name of `by`
  double sign = 1;                     // -1: the antipodal quaternion, the same attitude
  double norm = 1;
};

class Sampler {
 public:
  Sampler(const Signal& signal, const Timeline& timeline);

  double at(Nanoseconds time) const;

 private:
  Signal signal_;
  Timeline timeline_;
  std::vector<double> walk_;        // of a RandomWalk, one value per step
  std::vector<Nanoseconds> times_;  // of Samples
};

// The attitude with these angles [deg], in the order of the name of `by`.
Quaternion attitude_from(Angles by, const std::array<double, 3>& angles_deg);

// False only for a Constant.
bool varies(const Signal& signal);

}  // namespace attest
