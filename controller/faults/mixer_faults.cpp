// Wrong mixers: inputs, yaw and outputs.
#include <algorithm>
#include <cmath>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using Law = MixerStages::Law;
using Controls = MixerStages::Controls;
using Fit = MixerStages::Fit;
using Scales = Law::Scales;
using actuation::Rotor;
using actuation::Saturation;
using Rotors = std::span<const Rotor>;

// Replaces each rotor of the geometry.
template <typename Change>
void change_rotors(FaultyLaw& law, Change change) {
  change_stage(law.mixer.without_yaw,
               [change](const auto& then, const Rotor& rotor, const Controls& c, float scale) {
                 return then(change(rotor), c, scale);
               });
  change_stage(law.mixer.yield_yaw,
               [change](const auto& then, Rotors rotors, Controls& c, const Fit& fit) {
                 std::array<Rotor, actuation::rotors_max> changed{};
                 std::transform(rotors.begin(), rotors.end(), changed.begin(), change);
                 return then(Rotors(changed).first(rotors.size()), c, fit);
               });
  change_stage(law.mixer.command,
               [change](const auto& then, const Rotor& rotor, const Controls& c, const Fit& fit,
                        float idle) { return then(change(rotor), c, fit, idle); });
}

// Replaces the change of yaw and thrust at a rotor beyond its limits.
template <typename Yield>
void change_yield(FaultyLaw& law, Yield yield) {
  law.mixer.yield_yaw = [yield](Rotors rotors, Controls& c, const Fit& fit) {
    bool cut = false;
    for (const Rotor& rotor : rotors) {
      const float base = Law::without_yaw(rotor, c, fit.roll_pitch_scale) + fit.boost;
      const float out = base + c.yaw * rotor.yaw + c.thrust;
      if (out >= 0 && out <= 1) continue;
      yield(rotor, c, base, out);
      cut = true;
    }
    return cut;
  };
}

// Replaces only the thrust that is given up for yaw.
template <typename Thrust>
void change_thrust_given_up(FaultyLaw& law, Thrust given_up) {
  change_yield(law, [given_up](const Rotor& rotor, Controls& c, float base, float out) {
    if (out > 1) c.thrust -= given_up(out - 1);
    c.yaw = ((out > 1 ? 1.0f : 0.0f) - base - c.thrust) / rotor.yaw;
  });
}

const Fault mixer_list[] = {
    {"mixer-unclamped", "mixer", Stage::mixer_scaling, "does not clamp roll, pitch and yaw",
     "controls beyond 1", "missing clamp",
     [](FaultyLaw& law) {
       law.mixer.scaled = [](const Controls& c, const Scales& scales) {
         return Controls{c.roll * scales.roll, c.pitch * scales.pitch, c.yaw * scales.yaw,
                         Law::clamp(c.thrust, 0, 1)};
       };
     }},
    {"mixer-thrust-unclamped", "mixer", Stage::mixer_scaling, "does not clamp thrust to 0..1",
     "thrust outside 0..1", "missing clamp",
     [](FaultyLaw& law) {
       change_stage(law.mixer.scaled,
                    [](const auto& then, const Controls& c, const Scales& scales) {
                      Controls scaled = then(c, scales);
                      scaled.thrust = c.thrust;
                      return scaled;
                    });
     }},
    {"mixer-unscaled", "mixer", Stage::mixer_scaling, "ignores the scales of its definition",
     "a scale other than 1", "a missing factor",
     [](FaultyLaw& law) {
       change_stage(law.mixer.scaled, [](const auto& then, const Controls& c, const Scales&) {
         return then(c, {1, 1, 1, 0});
       });
     }},
    {"mixer-clamp-then-scale", "mixer", Stage::mixer_scaling, "clamps before it scales",
     "a control beyond 1 and a scale below 1", "scaling order",
     [](FaultyLaw& law) {
       change_stage(law.mixer.scaled,
                    [](const auto& then, const Controls& c, const Scales& scales) {
                      const Controls clamped = then(c, {1, 1, 1, 0});
                      return Controls{clamped.roll * scales.roll, clamped.pitch * scales.pitch,
                                      clamped.yaw * scales.yaw, clamped.thrust};
                    });
     }},
    {"mixer-scales-at-most-1", "mixer", Stage::mixer_scaling, "clamps scales to 1",
     "a scale beyond 1", "a helpful clamp",
     [](FaultyLaw& law) {
       change_stage(law.mixer.scaled,
                    [](const auto& then, const Controls& c, const Scales& scales) {
                      return then(c, {std::min(scales.roll, 1.0f), std::min(scales.pitch, 1.0f),
                                      std::min(scales.yaw, 1.0f), scales.idle});
                    });
     }},
    {"mixer-scales-unsigned", "mixer", Stage::mixer_scaling, "uses the magnitude of a scale",
     "a scale below 0", "a sign",
     [](FaultyLaw& law) {
       change_stage(law.mixer.scaled,
                    [](const auto& then, const Controls& c, const Scales& scales) {
                      return then(c, {std::abs(scales.roll), std::abs(scales.pitch),
                                      std::abs(scales.yaw), scales.idle});
                    });
     }},
    {"mixer-roll-left", "mixer", Stage::mixer_scaling, "rolls the other way", "roll", "a sign",
     [](FaultyLaw& law) {
       change_rotors(law, [](const Rotor& r) { return Rotor{-r.roll, r.pitch, r.yaw}; });
     }},
    {"mixer-pitch-down", "mixer", Stage::mixer_scaling, "pitches the other way", "pitch", "a sign",
     [](FaultyLaw& law) {
       change_rotors(law, [](const Rotor& r) { return Rotor{r.roll, -r.pitch, r.yaw}; });
     }},
    {"mixer-yaw-left", "mixer", Stage::mixer_scaling, "yaws the other way", "yaw",
     "propellers that turn the other way",
     [](FaultyLaw& law) {
       change_rotors(law, [](const Rotor& r) { return Rotor{r.roll, r.pitch, -r.yaw}; });
     }},
    {"mixer-roll-pitch-exchanged", "mixer", Stage::mixer_scaling, "exchanges roll and pitch",
     "roll or pitch", "wrong axis",
     [](FaultyLaw& law) {
       change_rotors(law, [](const Rotor& r) { return Rotor{r.pitch, r.roll, r.yaw}; });
     }},
    {"mixer-rotor-order", "mixer", Stage::mixer_scaling,
     "exchanges opposite rotors that turn clockwise", "roll or pitch", "another order of rotors",
     [](FaultyLaw& law) {
       change_rotors(law, [](const Rotor& r) {
         return r.yaw < 0 ? Rotor{-r.roll, -r.pitch, r.yaw} : r;
       });
     }},
    {"mixer-no-yaw-flag", "mixer", Stage::mixer_yaw, "never reports that yaw was cut",
     "yaw that saturates", "a missing step",
     [](FaultyLaw& law) {
       change_stage(law.mixer.yield_yaw,
                    [](const auto& then, Rotors rotors, Controls& c, const Fit& fit) {
                      then(rotors, c, fit);
                      return false;
                    });
     }},
    {"mixer-yaw-clipped", "mixer", Stage::mixer_yaw, "clips each rotor instead of cutting yaw",
     "yaw that saturates", "a missing step",
     [](FaultyLaw& law) { change_yield(law, [](const Rotor&, Controls&, float, float) {}); }},
    {"mixer-yaw-dropped", "mixer", Stage::mixer_yaw, "drops yaw where it does not fit",
     "yaw that saturates", "a helpful simplification",
     [](FaultyLaw& law) {
       change_yield(law, [](const Rotor&, Controls& c, float, float) { c.yaw = 0; });
     }},
    {"mixer-yaw-not-carried-on", "mixer", Stage::mixer_yaw,
     "does not carry the cut of one rotor on to the next", "yaw that several rotors cut",
     "a copy in place of a reference",
     [](FaultyLaw& law) {
       change_stage(law.mixer.yield_yaw,
                    [](const auto& then, Rotors rotors, Controls& c, const Fit& fit) {
                      const Controls given = c;
                      bool cut = false;
                      for (std::size_t i = 0; i < rotors.size(); ++i) {
                        Controls alone = given;
                        if (!then(rotors.subspan(i, 1), alone, fit)) continue;
                        c = alone;
                        cut = true;
                      }
                      return cut;
                    });
     }},
    {"mixer-yaw-keeps-thrust", "mixer", Stage::mixer_yaw, "gives up no thrust for yaw",
     "yaw at the upper limit", "a missing step",
     [](FaultyLaw& law) { change_thrust_given_up(law, [](float) { return 0.0f; }); }},
    {"mixer-yaw-takes-all-thrust", "mixer", Stage::mixer_yaw,
     "gives up thrust for yaw without a limit", "much yaw at the upper limit", "missing clamp",
     [](FaultyLaw& law) { change_thrust_given_up(law, [](float beyond) { return beyond; }); }},
    {"mixer-yaw-without-boost", "mixer", Stage::mixer_yaw, "leaves out the boost when it cuts yaw",
     "yaw together with roll that saturates", "a missing term",
     [](FaultyLaw& law) {
       change_stage(law.mixer.yield_yaw,
                    [](const auto& then, Rotors rotors, Controls& c, const Fit& fit) {
                      return then(rotors, c, {0, fit.roll_pitch_scale});
                    });
     }},
    {"mixer-output-0-to-1", "mixer", Stage::mixer_output, "outputs 0..1", "always",
     "another convention",
     [](FaultyLaw& law) {
       change_stage(law.mixer.command,
                    [](const auto& then, const Rotor& rotor, const Controls& c, const Fit& fit,
                       float idle) { return (then(rotor, c, fit, idle) + 1) / 2; });
     }},
    {"mixer-deadband-halved", "mixer", Stage::mixer_output, "lifts the idle by half the deadband",
     "a deadband", "a missing factor",
     [](FaultyLaw& law) {
       change_stage(law.mixer.command,
                    [](const auto& then, const Rotor& rotor, const Controls& c, const Fit& fit,
                       float idle) { return then(rotor, c, fit, (idle - 1) / 2); });
     }},
    {"mixer-idle-clips", "mixer", Stage::mixer_output, "clips at idle instead of scaling to it",
     "a deadband", "a helpful simplification",
     [](FaultyLaw& law) {
       change_stage(law.mixer.command,
                    [](const auto& then, const Rotor& rotor, const Controls& c, const Fit& fit,
                       float idle) { return std::max(idle, then(rotor, c, fit, -1)); });
     }},
    {"mixer-no-slew", "mixer", Stage::mixer_output, "does not limit the change of the outputs",
     "a limit and a jump", "a missing step",
     [](FaultyLaw& law) { law.mixer.slew = [](float wanted, float, float) { return wanted; }; }},
    {"mixer-first-call-from-0", "mixer", Stage::mixer_output,
     "without a deadband, limits the change from 0 at the first call", "a limit at the first call",
     "a wrong initial value",
     [](FaultyLaw& law) { law.mixer.starts_at_0 = [](float) { return true; }; }},
    {"mixer-first-call-free", "mixer", Stage::mixer_output,
     "with a deadband, does not limit the change at the first call",
     "a limit at the first call, and a deadband", "a wrong initial value",
     [](FaultyLaw& law) { law.mixer.starts_at_0 = [](float) { return false; }; }},
    {"mixer-slew-up-only", "mixer", Stage::mixer_output, "limits rising outputs only",
     "a limit and a fall", "a condition dropped",
     [](FaultyLaw& law) {
       change_stage(law.mixer.slew,
                    [](const auto& then, float wanted, float previous, float limit) {
                      return wanted < previous ? wanted : then(wanted, previous, limit);
                    });
     }},
    {"mixer-slew-always", "mixer", Stage::mixer_output,
     "treats 0 as a limit instead of as no limit", "no limit", "a condition dropped",
     [](FaultyLaw& law) {
       law.mixer.slew = [](float wanted, float previous, float limit) {
         return Law::clamp(wanted, previous - limit, previous + limit);
       };
     }},
    {"mixer-slew-by-magnitude", "mixer", Stage::mixer_output,
     "uses the magnitude of a negative limit", "a limit below 0", "a helpful simplification",
     [](FaultyLaw& law) {
       change_stage(law.mixer.slew,
                    [](const auto& then, float wanted, float previous, float limit) {
                      return then(wanted, previous, std::abs(limit));
                    });
     }},
};

}  // namespace

std::span<const Fault> mixer_faults() { return mixer_list; }

}  // namespace attest::faults
