// Wrong time steps of both units of the cascade.
#include <algorithm>
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

struct Bounds {
  float min_s, max_s;
};
constexpr Bounds attitude_bounds{0.0002f, 0.02f};
constexpr Bounds rate_bounds{0.000125f, 0.02f};

float seconds_between(std::uint64_t now_us, std::uint64_t last_us) {
  return static_cast<float>(now_us - last_us) * 1e-6f;
}

float clamped(float dt_s, const Bounds& bounds) {
  return cascade::clamp(dt_s, bounds.min_s, bounds.max_s);
}

// Limits dt to other bounds.
template <typename Unit>
void set_bounds(Unit& unit, Bounds bounds) {
  unit.step.step_time = [bounds](std::uint64_t now_us, std::uint64_t last_us) {
    return clamped(seconds_between(now_us, last_us), bounds);
  };
}

// Replaces the time between two samples, and keeps the bounds of dt. Measure is float(now, last).
template <typename Unit, typename Measure>
void measure(Unit& unit, const Bounds& bounds, Measure measured) {
  unit.step.step_time = [bounds, measured](std::uint64_t now_us, std::uint64_t last_us) mutable {
    return clamped(measured(now_us, last_us), bounds);
  };
}
template <typename Measure>
void measure_attitude(FaultyLaw& law, Measure measured) {
  measure(law.attitude_unit, attitude_bounds, measured);
}
template <typename Measure>
void measure_rate(FaultyLaw& law, Measure measured) {
  measure(law.rate_unit, rate_bounds, measured);
}

// A step that controls the rates asks whether it resets the integral.
void keep_time_while_controlled(FaultyLaw& law) {
  auto now = std::make_shared<std::uint64_t>(0), last = std::make_shared<std::uint64_t>(0);
  change_stage(law.rate_unit.step.step_time,
               [now, last](const auto& then, std::uint64_t now_us, std::uint64_t) {
                 *now = now_us;
                 return then(now_us, *last);
               });
  auto& resets = law.rate_unit.step.resets_integral;
  change_stage(resets, [now, last](const auto& then, const cascade::RateTopics& topics) {
    *last = *now;
    return then(topics);
  });
}

// The timestamps are converted to type Integer. Their difference does not wrap around.
template <typename Integer>
float difference_as(std::uint64_t now_us, std::uint64_t last_us) {
  const double now = static_cast<double>(static_cast<Integer>(now_us));
  return static_cast<float>((now - static_cast<double>(static_cast<Integer>(last_us))) * 1e-6);
}

float whole_milliseconds(std::uint64_t now_us, std::uint64_t last_us) {
  return static_cast<float>((now_us - last_us) / 1000) * 1e-3f;
}

float of_float_clock(std::uint64_t now_us, std::uint64_t last_us) {
  return (static_cast<float>(now_us) - static_cast<float>(last_us)) * 1e-6f;
}

// The difference of two clocks that count whole milliseconds.
float of_clock_in_ms(std::uint64_t now_us, std::uint64_t last_us) {
  return static_cast<float>(now_us / 1000 - last_us / 1000) * 1e-3f;
}

float milli_for_micro(std::uint64_t now_us, std::uint64_t last_us) {
  return static_cast<float>(now_us - last_us) * 1e-3f;
}

// The first step has the shortest dt.
float none_at_first(std::uint64_t now_us, std::uint64_t last_us) {
  return last_us == 0 ? 0 : seconds_between(now_us, last_us);
}

float four_ms(std::uint64_t, std::uint64_t) { return 0.004f; }

// The time that the previous step measured; 20 ms in the first step.
auto one_late() {
  return [dt_s = 0.02f](std::uint64_t now_us, std::uint64_t last_us) mutable {
    return std::exchange(dt_s, seconds_between(now_us, last_us));
  };
}

auto nominal() {
  return [n = 0, dt_s = 0.0f](std::uint64_t now_us, std::uint64_t last_us) mutable {
    if (n < 2) ++n, dt_s = seconds_between(now_us, last_us);
    return dt_s;
  };
}

auto filtered() {
  return [dt_s = 0.0f](std::uint64_t now_us, std::uint64_t last_us) mutable {
    const float fresh = seconds_between(now_us, last_us);
    dt_s = dt_s == 0 || last_us == 0 ? fresh : dt_s + 0.25f * (fresh - dt_s);
    return dt_s;
  };
}

const Fault timing_list[] = {
    {"cascade-attitude-dt-from-2-ms", "timing", Stage::timing,
     "limits dt of the attitude unit to 2 ms or more, as the older law", "rates above 500 Hz",
     "wrong clamp",
     [](FaultyLaw& law) {
       set_bounds(law.attitude_unit, {0.002f, 0.02f});
     }},
    {"cascade-attitude-dt-from-0.125-ms", "timing", Stage::timing,
     "limits dt of the attitude unit to 0.125 ms or more, as the rate unit", "rates above 5 kHz",
     "wrong clamp",
     [](FaultyLaw& law) {
       set_bounds(law.attitude_unit, {0.000125f, 0.02f});
     }},
    {"cascade-attitude-dt-no-maximum", "timing", Stage::timing,
     "does not bound dt of the attitude unit from above", "a gap of more than 20 ms",
     "missing clamp",
     [](FaultyLaw& law) {
       set_bounds(law.attitude_unit, {0.0002f, 1e9f});
     }},
    {"cascade-attitude-dt-unclamped", "timing", Stage::timing,
     "does not bound dt of the attitude unit", "a gap of more than 20 ms", "missing clamp",
     [](FaultyLaw& law) {
       set_bounds(law.attitude_unit, {0, 1e9f});
     }},
    {"cascade-attitude-dt-to-50-ms", "timing", Stage::timing,
     "limits dt of the attitude unit to 50 ms or less", "a gap of more than 20 ms", "wrong clamp",
     [](FaultyLaw& law) {
       set_bounds(law.attitude_unit, {0.0002f, 0.05f});
     }},
    {"cascade-attitude-dt-fixed", "timing", Stage::timing, "uses 4 ms as dt of the attitude unit",
     "any rate except 250 Hz", "a fixed rate",
     [](FaultyLaw& law) { measure_attitude(law, four_ms); }},
    {"cascade-attitude-dt-nominal", "timing", Stage::timing,
     "uses the first period as dt of the attitude unit in all steps", "jitter", "a fixed rate",
     [](FaultyLaw& law) { measure_attitude(law, nominal()); }},
    {"cascade-attitude-dt-one-late", "timing", Stage::timing,
     "uses the previous period in the attitude unit", "jitter", "one-tick delay",
     [](FaultyLaw& law) { measure_attitude(law, one_late()); }},
    {"cascade-attitude-dt-in-ms", "timing", Stage::timing,
     "counts whole milliseconds in the attitude unit", "333 Hz, or jitter", "integer division",
     [](FaultyLaw& law) { measure_attitude(law, whole_milliseconds); }},
    {"cascade-attitude-dt-of-step", "timing", Stage::timing,
     "takes dt of the attitude unit from the time of the step, not of the sample",
     "samples of another age", "another time",
     [](FaultyLaw& law) {
       also_before(law.attitude_unit,
                   [](AttitudeIn& in) { in.vehicle_attitude.timestamp_sample = in.timestamp; });
     }},
    {"cascade-attitude-dt-of-publication", "timing", Stage::timing,
     "takes dt of the attitude unit from the publication of the attitude, not from its sample",
     "samples of another age", "another time",
     [](FaultyLaw& law) {
       also_before(law.attitude_unit, [](AttitudeIn& in) {
         in.vehicle_attitude.timestamp_sample = in.vehicle_attitude.timestamp;
       });
     }},
    {"cascade-attitude-clock-in-float", "timing", Stage::timing,
     "holds timestamps of the attitude unit in float32", "a timestamp of seconds", "a narrow type",
     [](FaultyLaw& law) { measure_attitude(law, of_float_clock); }},
    {"cascade-attitude-clock-in-uint32", "timing", Stage::timing,
     "holds timestamps of the attitude unit in 32 bits, without wrap-around",
     "timestamps across 2^32 us", "a narrow type",
     [](FaultyLaw& law) { measure_attitude(law, difference_as<std::uint32_t>); }},
    {"cascade-attitude-dt-filtered", "timing", Stage::timing, "low-passes dt of the attitude unit",
     "jitter", "a helpful extra", [](FaultyLaw& law) { measure_attitude(law, filtered()); }},
    {"cascade-attitude-dt-milli-for-micro", "timing", Stage::timing,
     "takes the times of the attitude unit as milliseconds", "rates above 50 Hz", "a wrong unit",
     [](FaultyLaw& law) { measure_attitude(law, milli_for_micro); }},
    {"cascade-attitude-clock-in-ms", "timing", Stage::timing,
     "holds timestamps of the attitude unit in whole milliseconds", "333 Hz, or jitter",
     "integer division", [](FaultyLaw& law) { measure_attitude(law, of_clock_in_ms); }},
    {"cascade-attitude-clock-in-int32", "timing", Stage::timing,
     "holds timestamps of the attitude unit in 32 signed bits", "timestamps across 2^31 us",
     "a narrow type", [](FaultyLaw& law) { measure_attitude(law, difference_as<std::int32_t>); }},
    {"cascade-attitude-dt-first-is-minimum", "timing", Stage::timing,
     "uses the smallest dt in the first step of the attitude unit", "the first step",
     "initial state", [](FaultyLaw& law) { measure_attitude(law, none_at_first); }},
    {"cascade-rate-dt-from-2-ms", "timing", Stage::timing,
     "limits dt of the rate unit to 2 ms or more, as the older law", "rates above 500 Hz",
     "wrong clamp",
     [](FaultyLaw& law) {
       set_bounds(law.rate_unit, {0.002f, 0.02f});
     }},
    {"cascade-rate-dt-from-0.2-ms", "timing", Stage::timing,
     "limits dt of the rate unit to 0.2 ms or more, as the attitude unit", "rates above 5 kHz",
     "wrong clamp",
     [](FaultyLaw& law) {
       set_bounds(law.rate_unit, {0.0002f, 0.02f});
     }},
    {"cascade-rate-dt-no-minimum", "timing", Stage::timing,
     "does not bound dt of the rate unit from below", "two samples of one time", "missing clamp",
     [](FaultyLaw& law) {
       set_bounds(law.rate_unit, {0, 0.02f});
     }},
    {"cascade-rate-dt-no-maximum", "timing", Stage::timing,
     "does not bound dt of the rate unit from above", "a gap of more than 20 ms", "missing clamp",
     [](FaultyLaw& law) {
       set_bounds(law.rate_unit, {0.000125f, 1e9f});
     }},
    {"cascade-rate-dt-unclamped", "timing", Stage::timing, "does not bound dt of the rate unit",
     "a gap of more than 20 ms, or two samples of one time", "missing clamp",
     [](FaultyLaw& law) {
       set_bounds(law.rate_unit, {0, 1e9f});
     }},
    {"cascade-rate-dt-to-50-ms", "timing", Stage::timing,
     "limits dt of the rate unit to 50 ms or less", "a gap of more than 20 ms", "wrong clamp",
     [](FaultyLaw& law) {
       set_bounds(law.rate_unit, {0.000125f, 0.05f});
     }},
    {"cascade-rate-dt-to-0.2-s", "timing", Stage::timing,
     "limits dt of the rate unit to 0.2 s or less", "a gap of more than 20 ms", "wrong clamp",
     [](FaultyLaw& law) {
       set_bounds(law.rate_unit, {0.000125f, 0.2f});
     }},
    {"cascade-rate-dt-fixed-at-4-ms", "timing", Stage::timing, "uses 4 ms as dt of the rate unit",
     "any rate except 250 Hz", "a fixed rate",
     [](FaultyLaw& law) {
       measure_rate(law, [](std::uint64_t, std::uint64_t) { return 0.004f; });
     }},
    {"cascade-rate-clock-while-controlled", "timing", Stage::timing,
     "keeps the time of the last step only in steps that control the rates",
     "a step without control of the rates", "a misplaced statement", keep_time_while_controlled},
    {"cascade-rate-dt-fixed", "timing", Stage::timing, "uses 1 ms as dt of the rate unit",
     "any rate except 1 kHz", "a fixed rate",
     [](FaultyLaw& law) {
       measure_rate(law, [](std::uint64_t, std::uint64_t) { return 0.001f; });
     }},
    {"cascade-rate-dt-nominal", "timing", Stage::timing,
     "uses the first period as dt of the rate unit in all steps", "jitter", "a fixed rate",
     [](FaultyLaw& law) { measure_rate(law, nominal()); }},
    {"cascade-rate-dt-one-late", "timing", Stage::timing,
     "uses the previous period in the rate unit", "jitter", "one-tick delay",
     [](FaultyLaw& law) { measure_rate(law, one_late()); }},
    {"cascade-rate-clock-shared", "instances", Stage::timing,
     "holds the last timestamp of the rate unit in a variable that all instances share",
     "a second instance", "static state",
     [](FaultyLaw& law) {
       // Lives as long as any instance, so that a test vector does not depend on the previous one.
       static std::weak_ptr<std::uint64_t> of_living_instances;
       auto last = of_living_instances.lock();
       if (!last) of_living_instances = last = std::make_shared<std::uint64_t>(0);
       measure_rate(law, [last](std::uint64_t now, std::uint64_t) {
         return RateStepStages::Law::step_time(now, std::exchange(*last, now));
       });
     }},
    {"cascade-rate-dt-in-ms", "timing", Stage::timing, "counts whole milliseconds in the rate unit",
     "333 Hz, or jitter", "integer division",
     [](FaultyLaw& law) { measure_rate(law, whole_milliseconds); }},
    {"cascade-rate-dt-of-step", "timing", Stage::timing,
     "takes dt of the rate unit from the time of the step, not of the sample",
     "samples of another age", "another time",
     [](FaultyLaw& law) {
       also_before(law.rate_unit,
                   [](RateIn& in) { in.vehicle_angular_velocity.timestamp_sample = in.timestamp; });
     }},
    {"cascade-rate-clock-in-float", "timing", Stage::timing,
     "holds timestamps of the rate unit in float32", "a timestamp of seconds", "a narrow type",
     [](FaultyLaw& law) { measure_rate(law, of_float_clock); }},
    {"cascade-rate-clock-in-uint32", "timing", Stage::timing,
     "holds timestamps of the rate unit in 32 bits, without wrap-around",
     "timestamps across 2^32 us", "a narrow type",
     [](FaultyLaw& law) { measure_rate(law, difference_as<std::uint32_t>); }},
    {"cascade-rate-dt-filtered", "timing", Stage::timing, "low-passes dt of the rate unit",
     "jitter", "a helpful extra", [](FaultyLaw& law) { measure_rate(law, filtered()); }},
    {"cascade-rate-dt-milli-for-micro", "timing", Stage::timing,
     "takes the times of the rate unit as milliseconds", "rates above 50 Hz", "a wrong unit",
     [](FaultyLaw& law) { measure_rate(law, milli_for_micro); }},
    {"cascade-rate-clock-in-ms", "timing", Stage::timing,
     "holds timestamps of the rate unit in whole milliseconds", "333 Hz, or jitter",
     "integer division", [](FaultyLaw& law) { measure_rate(law, of_clock_in_ms); }},
    {"cascade-rate-clock-in-int32", "timing", Stage::timing,
     "holds timestamps of the rate unit in 32 signed bits", "timestamps across 2^31 us",
     "a narrow type", [](FaultyLaw& law) { measure_rate(law, difference_as<std::int32_t>); }},
    {"cascade-rate-dt-first-is-minimum", "timing", Stage::timing,
     "uses the smallest dt in the first step of the rate unit", "the first step", "initial state",
     [](FaultyLaw& law) { measure_rate(law, none_at_first); }},
};

}  // namespace

std::span<const Fault> timing_faults() { return timing_list; }

}  // namespace attest::faults::in_cascade
