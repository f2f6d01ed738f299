// Wrong throttle attenuations of the P term.
#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"
#include "controller/faults/seen.hpp"

namespace attest::faults {
namespace {

using V = const Vector&;

// Replaces the attenuation by another function of thrust, break and slope.
template <typename Factor>
void change_attenuation(FaultyLaw& law, Factor factor) {
  law.rate.throttle_attenuation = [factor](float thrust, const RateGains& gains) {
    return factor(thrust, gains.tpa_break, gains.tpa_slope);
  };
}

float unit(float value) { return std::clamp(value, 0.0f, 1.0f); }

const Fault tpa_list[] = {
    {"tpa-missing", "tpa", Stage::tpa, "does not attenuate P", "thrust above the break",
     "a missing factor",
     [](FaultyLaw& law) { change_attenuation(law, [](float, float, float) { return 1.0f; }); }},
    {"tpa-on-d", "tpa", Stage::tpa, "attenuates D too", "thrust above the break",
     "a misplaced factor",
     [](FaultyLaw& law) {
       auto seen = watch(law);
       change_terms(law, [seen](ControlTerms& t) { t.d *= seen->attenuation; });
     }},
    {"tpa-on-ff", "tpa", Stage::tpa, "attenuates the feed-forward too", "thrust above the break",
     "a misplaced factor",
     [](FaultyLaw& law) {
       auto seen = watch(law);
       change_terms(law, [seen](ControlTerms& t) { t.ff *= seen->attenuation; });
     }},
    {"tpa-on-all", "tpa", Stage::tpa, "attenuates the whole control", "thrust above the break",
     "a misplaced factor",
     [](FaultyLaw& law) {
       auto seen = watch(law);
       change_terms(law, [seen](ControlTerms& t) {
         for (Vector* term : {&t.d, &t.i, &t.ff}) *term *= seen->attenuation;
       });
     }},
    {"tpa-on-growth", "tpa", Stage::tpa, "integrates the attenuated error",
     "thrust above the break", "a misplaced factor",
     [](FaultyLaw& law) {
       auto seen = watch(law);
       change_stage(law.rate.growth,
                    [seen](const auto& then, V error, float dt, const RateGains& gains) {
                      return then(error * seen->attenuation, dt, gains);
                    });
     }},
    {"tpa-negative", "tpa", Stage::tpa, "lets the factor become negative", "a steep slope",
     "missing clamp",
     [](FaultyLaw& law) {
       change_attenuation(law, [](float thrust, float from, float slope) {
         return std::min(1.0f, 1 - slope * (std::abs(thrust) - from));
       });
     }},
    {"tpa-above-1", "tpa", Stage::tpa, "lets the factor exceed 1", "thrust below the break",
     "missing clamp",
     [](FaultyLaw& law) {
       change_attenuation(law, [](float thrust, float from, float slope) {
         return std::max(0.0f, 1 - slope * (std::abs(thrust) - from));
       });
     }},
    {"tpa-signed", "tpa", Stage::tpa, "uses the signed thrust", "negative thrust", "a sign",
     [](FaultyLaw& law) {
       change_attenuation(law, [](float thrust, float from, float slope) {
         return unit(1 - slope * (thrust - from));
       });
     }},
    {"tpa-exchanged", "tpa", Stage::tpa, "exchanges break and slope", "thrust above the break",
     "a wrong parameter",
     [](FaultyLaw& law) {
       change_attenuation(law, [](float thrust, float from, float slope) {
         return unit(1 - from * (std::abs(thrust) - slope));
       });
     }},
    {"tpa-without-break", "tpa", Stage::tpa, "attenuates from zero thrust", "thrust, with a slope",
     "a missing term",
     [](FaultyLaw& law) {
       change_attenuation(law, [](float thrust, float, float slope) {
         return unit(1 - slope * std::abs(thrust));
       });
     }},
    {"tpa-relative", "tpa", Stage::tpa,
     "attenuates by the relative thrust above the break, as other firmware does",
     "thrust above the break", "another law",
     [](FaultyLaw& law) {
       change_attenuation(law, [](float thrust, float from, float slope) {
         const float above = std::max(0.0f, std::abs(thrust) - from);
         return unit(1 - slope * above / std::max(1e-6f, 1 - from));
       });
     }},
    {"tpa-late", "tpa", Stage::tpa, "attenuates by the thrust of the previous step",
     "thrust that changes above the break", "one-tick delay",
     [](FaultyLaw& law) {
       change_stage(law.rate.throttle_attenuation,
                    [last = 0.0f](const auto& then, float thrust, const RateGains& gains) mutable {
                      std::swap(last, thrust);
                      return then(thrust, gains);
                    });
     }},
    {"tpa-yaw-spared", "tpa", Stage::tpa, "does not attenuate yaw", "thrust above the break",
     "wrong axis",
     [](FaultyLaw& law) {
       change_stage(law.rate.proportional,
                    [](const auto& then, V error, float attenuation, const RateGains& gains) {
                      Vector p = then(error, attenuation, gains);
                      p[2] = gains.proportional[2] * error[2];
                      return p;
                    });
     }},
    {"tpa-by-current-thrust", "tpa", Stage::tpa, "attenuates by this step's thrust",
     "thrust that changes", "a wrong input", [](FaultyLaw& law) { (void)law; },
     "the copy of vehicle_rates_setpoint has just been written or latched: its thrust is this "
     "step's"},
};

}  // namespace

std::span<const Fault> tpa_faults() { return tpa_list; }

}  // namespace attest::faults
