// Wrong time steps of the controller.
#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

float seconds(std::uint64_t now, std::uint64_t last) {
  return static_cast<float>(now - last) / 1e6f;
}

template <typename Step>
void change_step(FaultyLaw& law, Step step) {
  law.step.step_time = step;
}

const Fault timing_list[] = {
    {"dt-no-minimum", "timing", Stage::timing, "does not bound dt from below", "rates above 500 Hz",
     "missing clamp",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         return std::min(seconds(now, last), 0.02f);
       });
     }},
    {"dt-no-maximum", "timing", Stage::timing, "does not bound dt from above",
     "a gap of more than 20 ms", "missing clamp",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         return std::max(seconds(now, last), 0.002f);
       });
     }},
    {"dt-unclamped", "timing", Stage::timing, "does not bound dt", "rates above 500 Hz, or a gap",
     "dt unclamped",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         return std::max(seconds(now, last), 1e-6f);
       });
     }},
    {"dt-from-1-ms", "timing", Stage::timing, "bounds dt below at 1 ms, not 2 ms",
     "rates above 500 Hz", "wrong clamp",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         return std::clamp(seconds(now, last), 0.001f, 0.02f);
       });
     }},
    {"dt-to-50-ms", "timing", Stage::timing, "bounds dt above at 50 ms, not 20 ms",
     "a gap of more than 20 ms", "wrong clamp",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         return std::clamp(seconds(now, last), 0.002f, 0.05f);
       });
     }},
    {"dt-fixed", "timing", Stage::timing, "uses 4 ms as dt in every step", "any rate except 250 Hz",
     "a fixed rate",
     [](FaultyLaw& law) { change_step(law, [](std::uint64_t, std::uint64_t) { return 0.004f; }); }},
    {"dt-nominal", "timing", Stage::timing, "uses the first period as dt in all steps",
     "jitter, or a dropped tick", "a fixed rate",
     [](FaultyLaw& law) {
       change_stage(law.step.step_time, [n = 0, dt = 0.0f](const auto& then, std::uint64_t now,
                                                           std::uint64_t last) mutable {
         if (n++ < 2) dt = then(now, last);
         return dt;
       });
     }},
    {"dt-first-is-minimum", "timing", Stage::timing, "uses 2 ms as dt in the first step",
     "the first step", "initial state",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         return last == 0 ? 0.002f : StepStages::Law::step_time(now, last);
       });
     }},
    {"dt-one-late", "timing", Stage::timing, "uses the previous period", "jitter", "one-tick delay",
     [](FaultyLaw& law) {
       change_stage(law.step.step_time,
                    [dt = 0.02f](const auto& then, std::uint64_t now, std::uint64_t last) mutable {
                      return std::exchange(dt, then(now, last));
                    });
     }},
    {"dt-in-ms", "timing", Stage::timing, "counts whole milliseconds", "333 Hz, or jitter",
     "integer division",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         const auto ms = static_cast<float>((now - last) / 1000);
         return std::clamp(ms / 1000, 0.002f, 0.02f);
       });
     }},
    {"dt-milli-for-micro", "timing", Stage::timing, "divides microseconds by 1000", "any step",
     "a wrong factor",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         return std::clamp(seconds(now, last) * 1000, 0.002f, 0.02f);
       });
     }},
    {"clock-in-float", "timing", Stage::timing, "holds timestamps in float32",
     "a timestamp of seconds", "a narrow type",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         const float dt = (static_cast<float>(now) - static_cast<float>(last)) / 1e6f;
         return std::clamp(dt, 0.002f, 0.02f);
       });
     }},
    {"clock-in-int32", "timing", Stage::timing, "holds timestamps in 32 signed bits",
     "timestamps beyond 2^31 us", "a narrow type",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         const auto low = [](std::uint64_t t) {
           return static_cast<double>(static_cast<std::int32_t>(t & 0xffffffffu));
         };
         return std::clamp(static_cast<float>((low(now) - low(last)) / 1e6), 0.002f, 0.02f);
       });
     }},
    {"clock-in-uint32", "timing", Stage::timing,
     "holds timestamps in 32 bits and subtracts them without wrap-around",
     "timestamps across 2^32 us", "a narrow type",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         const auto low = [](std::uint64_t t) { return static_cast<double>(t & 0xffffffffu); };
         return std::clamp(static_cast<float>((low(now) - low(last)) / 1e6), 0.002f, 0.02f);
       });
     }},
    {"clock-in-33-bits", "timing", Stage::timing, "holds timestamps in 33 bits",
     "timestamps across 2^33 us", "a narrow type",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         const auto low = [](std::uint64_t t) { return static_cast<double>(t & 0x1ffffffffu); };
         return std::clamp(static_cast<float>((low(now) - low(last)) / 1e6), 0.002f, 0.02f);
       });
     }},
    {"clock-in-ms", "timing", Stage::timing, "holds timestamps in whole milliseconds",
     "333 Hz, or jitter", "integer division",
     [](FaultyLaw& law) {
       change_step(law, [](std::uint64_t now, std::uint64_t last) {
         const auto ms = static_cast<float>(now / 1000 - last / 1000);
         return std::clamp(ms / 1000, 0.002f, 0.02f);
       });
     }},
    {"dt-filtered", "timing", Stage::timing, "low-passes dt", "jitter", "a helpful extra",
     [](FaultyLaw& law) {
       change_stage(law.step.step_time,
                    [dt = 0.0f](const auto& then, std::uint64_t now, std::uint64_t last) mutable {
                      const float fresh = then(now, last);
                      dt = dt == 0 || last == 0 ? fresh : dt + 0.25f * (fresh - dt);
                      return dt;
                    });
     }},
};

}  // namespace

std::span<const Fault> timing_faults() { return timing_list; }

}  // namespace attest::faults
