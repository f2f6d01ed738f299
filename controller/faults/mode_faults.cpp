// Mistakes in modes: the choice of the outer loop, its inputs, and what it publishes.
#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using Manual = decltype(Topics::manual);

template <typename Beyond>
void change_sticks(FaultyLaw& law, Beyond beyond) {
  law.step.sticks_beyond = beyond;
}

template <typename Change>
void change_acro(FaultyLaw& law, Change change) {
  change_stage(law.step.acro, [change](const auto& then, const Manual& manual, const Gains& gains) {
    RateCommand command = then(manual, gains);
    change(command, manual, gains);
    return command;
  });
}

bool flies_attitude(const attest_inputs& in) {
  return in.vehicle_control_mode.flag_control_attitude_enabled != 0;
}
bool flies_outside_rates(const attest_inputs& in) {
  return !flies_attitude(in) && in.vehicle_control_mode.flag_control_manual_enabled == 0;
}

// Keeps the external rates setpoint separate from the unit's own.
void keep_rates_apart(FaultyLaw& law) {
  also_before(law, [external = decltype(attest_inputs::vehicle_rates_setpoint){}](
                       attest_inputs& in) mutable {
    if ((in.updated & ATTEST_UPDATED_VEHICLE_RATES_SETPOINT) != 0) {
      external = in.vehicle_rates_setpoint;
    }
    in.vehicle_rates_setpoint = external;
    in.updated |= ATTEST_UPDATED_VEHICLE_RATES_SETPOINT;
  });
}

const Fault modes[] = {
    {"rattitude-not-latched", "modes", Stage::mode, "returns to attitude when the stick returns",
     "a stick that comes back in rattitude", "a latch",
     [](FaultyLaw& law) {
       also_before(law, [mode = Topics{}.mode](attest_inputs& in) mutable {
         if ((in.updated & ATTEST_UPDATED_VEHICLE_CONTROL_MODE) != 0)
           mode = in.vehicle_control_mode;
         in.vehicle_control_mode = mode;
         in.updated |= ATTEST_UPDATED_VEHICLE_CONTROL_MODE;
       });
     }},
    {"rattitude-for-good", "modes", Stage::mode, "stays in rates mode when a new mode is published",
     "a new mode after a large deflection", "a latch",
     [](FaultyLaw& law) {
       change_stage(
           law.step.sticks_beyond,
           [latched = false](const auto& then, const Manual& manual, float threshold) mutable {
             latched = latched || then(manual, threshold);
             return latched;
           });
     }},
    {"rattitude-missing", "modes", Stage::mode, "does not implement rattitude",
     "a large deflection", "a missing step",
     [](FaultyLaw& law) { change_sticks(law, [](const Manual&, float) { return false; }); }},
    {"rattitude-roll-only", "modes", Stage::mode, "checks the roll stick only",
     "a large pitch deflection", "wrong axis",
     [](FaultyLaw& law) {
       change_sticks(law, [](const Manual& m, float th) { return std::abs(m.y) > th; });
     }},
    {"rattitude-pitch-only", "modes", Stage::mode, "checks the pitch stick only",
     "a large roll deflection", "wrong axis",
     [](FaultyLaw& law) {
       change_sticks(law, [](const Manual& m, float th) { return std::abs(m.x) > th; });
     }},
    {"rattitude-both", "modes", Stage::mode, "needs both sticks", "one large deflection",
     "a condition changed",
     [](FaultyLaw& law) {
       change_sticks(
           law, [](const Manual& m, float th) { return std::abs(m.x) > th && std::abs(m.y) > th; });
     }},
    {"rattitude-yaw-too", "modes", Stage::mode, "checks the yaw stick too",
     "a large yaw deflection", "wrong axis",
     [](FaultyLaw& law) {
       change_sticks(law, [](const Manual& m, float th) {
         return StepStages::Law::sticks_beyond(m, th) || std::abs(m.r) > th;
       });
     }},
    {"rattitude-signed", "modes", Stage::mode, "checks positive deflections only",
     "a large negative deflection", "a sign",
     [](FaultyLaw& law) {
       change_sticks(law, [](const Manual& m, float th) { return m.x > th || m.y > th; });
     }},
    {"rattitude-not-strict", "modes", Stage::mode, "flies rates at the threshold",
     "a deflection of exactly MC_RATT_TH", "a condition made non-strict",
     [](FaultyLaw& law) {
       change_sticks(law, [](const Manual& m, float th) {
         return std::abs(m.x) >= th || std::abs(m.y) >= th;
       });
     }},
    {"rattitude-everywhere", "modes", Stage::mode, "does not check the rattitude flag",
     "a large deflection in ALTCTL", "a condition dropped",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         in.vehicle_control_mode.flag_control_rattitude_enabled = 1;
       });
     }},
    {"acro-pitch-reversed", "modes", Stage::mode, "does not negate the pitch stick",
     "a pitch stick in acro", "a sign",
     [](FaultyLaw& law) {
       change_acro(law, [](RateCommand& command, const Manual&, const Gains&) {
         command.rates_sp_B[1] = -command.rates_sp_B[1];
       });
     }},
    {"acro-sticks-exchanged", "modes", Stage::mode, "exchanges x and y in acro", "sticks in acro",
     "wrong axis",
     [](FaultyLaw& law) {
       change_acro(law, [](RateCommand& command, const Manual& m, const Gains& gains) {
         command.rates_sp_B = Vector(m.x, -m.y, m.r).cwiseProduct(gains.acro_rate_max_rad_s);
       });
     }},
    {"acro-in-degrees", "modes", Stage::mode, "leaves acro rates in degrees", "sticks in acro",
     "degrees",
     [](FaultyLaw& law) {
       change_acro(law, [](RateCommand& command, const Manual&, const Gains&) {
         command.rates_sp_B *= 57.29578f;
       });
     }},
    {"acro-expo", "modes", Stage::mode, "puts an expo curve on the sticks", "half a stick in acro",
     "a helpful extra",
     [](FaultyLaw& law) {
       change_acro(law, [](RateCommand& command, const Manual& m, const Gains&) {
         command.rates_sp_B[0] *= 0.3f + 0.7f * m.y * m.y;
       });
     }},
    {"acro-limited", "modes", Stage::limit, "limits acro rates to the limits of attitude mode",
     "a full stick in acro", "misplaced clamp",
     [](FaultyLaw& law) {
       change_acro(law, [](RateCommand& command, const Manual&, const Gains& gains) {
         command.rates_sp_B =
             mc_att_control::clamp_each<float>(command.rates_sp_B, gains.attitude.rate_max_rad_s);
       });
     }},
    {"acro-thrust-whole", "modes", Stage::mode, "does not limit thrust in acro",
     "full throttle in acro", "missing clamp",
     [](FaultyLaw& law) {
       change_acro(law, [](RateCommand& command, const Manual& m, const Gains&) {
         command.thrust_sp = m.z;
       });
     }},
    {"acro-thrust-scaled", "modes", Stage::mode, "scales the throttle by 0.9",
     "any throttle in acro", "wrong clamp",
     [](FaultyLaw& law) {
       change_acro(law, [](RateCommand& command, const Manual& m, const Gains&) {
         command.thrust_sp = m.z * 0.9f;
       });
     }},
    {"acro-thrust-not-negative", "modes", Stage::mode, "clamps a negative throttle to 0",
     "a negative throttle in acro", "misplaced clamp",
     [](FaultyLaw& law) {
       change_acro(law, [](RateCommand& command, const Manual&, const Gains&) {
         if (command.thrust_sp < 0) command.thrust_sp = 0;
       });
     }},
    {"acro-silent", "modes", Stage::output, "does not publish its rates setpoint in acro", "acro",
     "a missing step",
     [](FaultyLaw& law) {
       also_after(law,
                  [last = attest_outputs{}](const attest_inputs& in, attest_outputs& out) mutable {
                    if (!flies_attitude(in))
                      out.vehicle_rates_setpoint = last.vehicle_rates_setpoint;
                    if (!flies_attitude(in)) out.vehicle_rates_setpoint.published = 0;
                    last = out;
                  });
     }},
    {"manual-first", "modes", Stage::mode, "checks the manual flag before the attitude flag",
     "STABILIZED", "order of conditions",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         if (in.vehicle_control_mode.flag_control_manual_enabled != 0) {
           in.vehicle_control_mode.flag_control_attitude_enabled = 0;
         }
       });
     }},
    {"offboard-published", "modes", Stage::output, "publishes external rates", "OFFBOARD rates",
     "a helpful extra",
     [](FaultyLaw& law) {
       also_after(law, [](const attest_inputs& in, attest_outputs& out) {
         if (flies_outside_rates(in)) out.vehicle_rates_setpoint.published = 1;
       });
     }},
    {"offboard-apart", "modes", Stage::mode, "keeps external rates separate from the unit's own",
     "OFFBOARD rates after another mode", "a variable too many", keep_rates_apart},
    {"offboard-limited", "modes", Stage::limit, "limits external rates", "fast external rates",
     "misplaced clamp",
     [](FaultyLaw& law) {
       auto bound = std::make_shared<Vector>(Vector::Zero());
       change_stage(law.step.gains, [bound](const auto& then, const Parameters& parameters) {
         const Gains gains = then(parameters);
         *bound = gains.attitude.rate_max_rad_s;
         return gains;
       });
       also_before(law, [bound](attest_inputs& in) {
         auto& sp = in.vehicle_rates_setpoint;
         if ((*bound)[0] == 0) return;
         sp.roll = mc_att_control::clamp(sp.roll, -(*bound)[0], (*bound)[0]);
         sp.pitch = mc_att_control::clamp(sp.pitch, -(*bound)[1], (*bound)[1]);
         sp.yaw = mc_att_control::clamp(sp.yaw, -(*bound)[2], (*bound)[2]);
       });
     }},
    {"pending-lost", "modes", Stage::mode,
     "loses an attitude setpoint that arrived in another mode", "a setpoint before the mode",
     "a latch",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         if (!flies_attitude(in))
           in.updated &= ~std::uint32_t{ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT};
       });
     }},
    {"pending-rates-lost", "modes", Stage::mode, "loses rates that arrived in another mode",
     "rates before OFFBOARD", "a latch",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         if (!flies_outside_rates(in))
           in.updated &= ~std::uint32_t{ATTEST_UPDATED_VEHICLE_RATES_SETPOINT};
       });
     }},
    {"vtol-supersedes", "modes", Stage::mode,
     "drops a pending rates sample when a VTOL publishes its own", "is_vtol, rates before OFFBOARD",
     "a condition dropped",
     [](FaultyLaw& law) { law.step.supersedes_pending = [](bool) { return true; }; }},
    {"own-rates-do-not-supersede", "modes", Stage::mode,
     "uses an external rates sample that is older than its own", "rates before OFFBOARD", "a latch",
     [](FaultyLaw& law) { law.step.supersedes_pending = [](bool) { return false; }; }},
    {"topics-by-latest-status", "modes", Stage::mode,
     "selects its topics by each vehicle_status, not only by the first", "is_vtol changes",
     "a latch",
     [](FaultyLaw& law) {
       const auto is_vtol = std::make_shared<bool>(false);
       also_before(law, [is_vtol](attest_inputs& in) {
         if ((in.updated & ATTEST_UPDATED_VEHICLE_STATUS) == 0) return;
         *is_vtol = in.vehicle_status.is_vtol != 0;
       });
       law.step.supersedes_pending = [is_vtol](bool) { return !*is_vtol; };
     }},
    {"mode-late", "modes", Stage::mode, "changes its mode one tick late", "a change of mode",
     "one-tick delay",
     [](FaultyLaw& law) {
       also_before(law, [last = Topics{}.mode](attest_inputs& in) mutable {
         std::swap(last, in.vehicle_control_mode);
         in.updated |= ATTEST_UPDATED_VEHICLE_CONTROL_MODE;
       });
     }},
    {"sticks-late", "modes", Stage::mode, "reads the sticks one tick late", "sticks that move",
     "one-tick delay",
     [](FaultyLaw& law) {
       also_before(law, [last = Manual{}](attest_inputs& in) mutable {
         std::swap(last, in.manual_control_setpoint);
         in.updated |= ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT;
       });
     }},
    {"rates-always", "modes", Stage::mode, "controls rates in every mode", "TERMINATION",
     "a condition dropped",
     [](FaultyLaw& law) {
       also_before(
           law, [](attest_inputs& in) { in.vehicle_control_mode.flag_control_rates_enabled = 1; });
     }},
    {"termination-zeroes", "modes", Stage::output, "publishes zeros where rates are not controlled",
     "TERMINATION", "a helpful extra",
     [](FaultyLaw& law) {
       also_after(law, [](const attest_inputs& in, attest_outputs& out) {
         if (in.vehicle_control_mode.flag_control_rates_enabled != 0) return;
         for (float& c : out.actuator_controls_0.control) c = 0;
         out.actuator_controls_0.published = 1;
       });
     }},
    {"termination-resets", "modes", Stage::i, "resets the integrals where rates are not controlled",
     "TERMINATION and back", "a reset too many",
     [](FaultyLaw& law) {
       auto stopped = std::make_shared<bool>(false);
       also_before(law, [stopped](attest_inputs& in) {
         if (in.vehicle_control_mode.flag_control_rates_enabled == 0) *stopped = true;
       });
       change_stage(law.step.is_flying, [stopped](const auto& then, const Topics& topics) {
         return then(topics) && !std::exchange(*stopped, false);
       });
     }},
    {"mode-resets", "modes", Stage::i, "resets the integrals when the mode changes",
     "a change of mode after some integration", "a reset too many",
     [](FaultyLaw& law) {
       auto changed = std::make_shared<bool>(false);
       also_before(law, [changed, last = true](attest_inputs& in) mutable {
         *changed = flies_attitude(in) != last;
         last = flies_attitude(in);
       });
       change_stage(law.step.is_flying, [changed](const auto& then, const Topics& topics) {
         return then(topics) && !*changed;
       });
     }},
};

}  // namespace

std::span<const Fault> mode_faults() { return modes; }

}  // namespace attest::faults
