// Wrong mixers: the fit of roll and pitch between the limits, and the saturation flags.
#include <algorithm>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using Law = MixerStages::Law;
using Fit = MixerStages::Fit;
using actuation::Saturation;

// Changes the fit of roll and pitch. `change` gets the law's fit, min_out, max_out and thrust.
template <typename Change>
void change_fit(FaultyLaw& law, Change change) {
  change_stage(law.mixer.fit,
               [change](const auto& then, float min_out, float max_out, float thrust) {
                 return change(then(min_out, max_out, thrust), min_out, max_out, thrust);
               });
}

const Fault mixer_fit_list[] = {
    {"mixer-no-fit", "mixer", Stage::mixer_fit, "clips each output at its limits",
     "roll or pitch that saturate", "a missing step",
     [](FaultyLaw& law) { law.mixer.fit = [](float, float, float) { return Fit{}; }; }},
    {"mixer-no-boost", "mixer", Stage::mixer_fit, "does not change thrust to keep roll and pitch",
     "roll or pitch that saturate", "a missing term",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float, float, float) { return Fit{0, fit.roll_pitch_scale}; });
     }},
    {"mixer-boost-unlimited", "mixer", Stage::mixer_fit, "raises thrust without a limit",
     "roll at little thrust", "missing clamp",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float) {
         return min_out < 0 && -min_out <= 1 - max_out ? Fit{-min_out, 1} : fit;
       });
     }},
    {"mixer-roll-pitch-unscaled", "mixer", Stage::mixer_fit, "does not scale roll and pitch down",
     "roll or pitch that no change of thrust makes fit", "a missing factor",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float, float, float) { return Fit{fit.boost, 1}; });
     }},
    {"mixer-raise-to-1.6", "mixer", Stage::mixer_fit, "raises thrust to 1.6 times, not 1.5 times",
     "roll that needs more than 1.5 times the thrust", "a wrong constant",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float thrust) {
         const float up = 0.6f * thrust;
         const bool wants = min_out < 0 && max_out < 1 && -min_out <= 1 - max_out;
         if (!wants || up >= -min_out) return wants ? Fit{-min_out, 1} : fit;
         return Fit{up, (thrust + up) / (thrust - min_out)};
       });
     }},
    {"mixer-lower-by-0.6", "mixer", Stage::mixer_fit,
     "lowers thrust by 0.6 of it, not to 0.6 of it", "roll near full thrust", "a wrong constant",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float thrust) {
         const float down = 0.6f * thrust;
         const bool wants = max_out > 1 && min_out > 0 && min_out >= max_out - 1;
         return wants && down >= max_out - 1 ? Fit{-(max_out - 1), 1} : fit;
       });
     }},
    {"mixer-not-in-the-middle", "mixer", Stage::mixer_fit,
     "lifts the lowest rotor to its limit where the room above is too small",
     "roll that fits at neither end", "a missing term",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float thrust) {
         if (!(min_out < 0 && max_out < 1 && -min_out > 1 - max_out)) return fit;
         const float boost = Law::clamp(-min_out, 0, 0.5f * thrust);
         return Fit{boost, (thrust + boost) / (thrust - min_out)};
       });
     }},
    {"mixer-both-ends-from-above", "mixer", Stage::mixer_fit,
     "scales by the upper limit where both limits are exceeded", "roll beyond both limits",
     "wrong branch threshold",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float thrust) {
         if (!(min_out < 0 && max_out > 1)) return fit;
         return Fit{fit.boost, (1 - (thrust + fit.boost)) / (max_out - thrust)};
       });
     }},
    {"mixer-both-ends-lower-unlimited", "mixer", Stage::mixer_fit,
     "lowers thrust to the middle without a limit where both limits are exceeded",
     "roll and pitch at almost full thrust", "missing clamp",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float thrust) {
         if (!(min_out < 0 && max_out > 1)) return fit;
         const float boost = std::min(-(max_out - 1 + min_out) / 2, 0.5f * thrust);
         return Fit{boost, (thrust + boost) / (thrust - min_out)};
       });
     }},
    {"mixer-above-lower-unlimited", "mixer", Stage::mixer_fit,
     "lowers thrust to the middle without a limit where the upper limit is exceeded",
     "roll with little room below, at almost full thrust", "missing clamp",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float thrust) {
         if (!(max_out > 1 && min_out > 0 && min_out < max_out - 1)) return fit;
         const float boost = -(max_out - 1 - min_out) / 2;
         return Fit{boost, (1 - (thrust + boost)) / (max_out - thrust)};
       });
     }},
    {"mixer-middle-from-below-strict", "mixer", Stage::mixer_fit,
     "treats room above that equals the excess below as too small", "room that equals the excess",
     "comparison made strict",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float thrust) {
         if (!(min_out < 0 && max_out < 1 && -min_out == 1 - max_out)) return fit;
         const float boost = Law::clamp(-min_out - (1 - max_out) / 2, 0, 0.5f * thrust);
         return Fit{boost, (thrust + boost) / (thrust - min_out)};
       });
     }},
    {"mixer-middle-from-above-strict", "mixer", Stage::mixer_fit,
     "treats room below that equals the excess above as too small", "room that equals the excess",
     "comparison made strict",
     [](FaultyLaw& law) {
       change_fit(law, [](Fit fit, float min_out, float max_out, float thrust) {
         if (!(max_out > 1 && min_out > 0 && min_out == max_out - 1)) return fit;
         return Fit{0, (1 - thrust) / (max_out - thrust)};
       });
     }},
    {"mixer-flags-exchanged", "mixer", Stage::mixer_fit, "exchanges lower and upper limit",
     "a rotor at a limit", "wrong order",
     [](FaultyLaw& law) {
       law.mixer.saturation = [](float min_out, float max_out) {
         return Saturation{max_out > 1, min_out < 0, false};
       };
     }},
    {"mixer-no-lower-flag", "mixer", Stage::mixer_fit, "never reports the lower limit",
     "a rotor at its lower limit", "a missing step",
     [](FaultyLaw& law) {
       law.mixer.saturation = [](float, float max_out) {
         return Saturation{false, max_out > 1, false};
       };
     }},
    {"mixer-no-upper-flag", "mixer", Stage::mixer_fit, "never reports the upper limit",
     "a rotor at its upper limit", "a missing step",
     [](FaultyLaw& law) {
       law.mixer.saturation = [](float min_out, float) {
         return Saturation{min_out < 0, false, false};
       };
     }},
};

}  // namespace

std::span<const Fault> mixer_fit_faults() { return mixer_fit_list; }

}  // namespace attest::faults
