// Wrong start and end of a flight: arming, the kind of vehicle, topics without a sample yet.
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

const Fault arming_list[] = {
    {"disarm-keeps-integral", "arming", Stage::arming, "does not reset the integrals on disarm",
     "disarmed after some integration", "a missing reset",
     [](FaultyLaw& law) {
       law.step.is_flying = [](const Topics& topics) { return topics.is_rotary_wing; };
     }},
    {"fixed-wing-keeps-integral", "arming", Stage::arming,
     "does not reset the integrals of a fixed wing", "a transition", "a missing reset",
     [](FaultyLaw& law) {
       law.step.is_flying = [](const Topics& topics) { return topics.armed; };
     }},
    {"reset-needs-both", "arming", Stage::arming, "resets only when disarmed as a fixed wing",
     "disarmed as a rotary wing", "a condition changed",
     [](FaultyLaw& law) {
       law.step.is_flying = [](const Topics& topics) {
         return topics.armed || topics.is_rotary_wing;
       };
     }},
    {"reset-on-arming", "arming", Stage::arming, "resets at arming, not while disarmed", "disarmed",
     "a missing reset",
     [](FaultyLaw& law) {
       change_stage(law.step.is_flying,
                    [was = false](const auto& then, const Topics& topics) mutable {
                      const bool is = then(topics);
                      return std::exchange(was, is) || !is;
                    });
     }},
    {"reset-after-update", "arming", Stage::arming, "does not update the integrals while disarmed",
     "disarmed with thrust", "order of stages",
     [](FaultyLaw& law) {
       auto flying = std::make_shared<bool>(true);
       change_stage(law.step.is_flying, [flying](const auto& then, const Topics& topics) {
         return *flying = then(topics);
       });
       change_stage(law.rate.integrate_axis,
                    [flying](const auto& then, float integral, float control, float thrust,
                             float growth, bool frozen) {
                      return *flying ? then(integral, control, thrust, growth, frozen) : 0.0f;
                    });
     }},
    {"disarmed-zero", "arming", Stage::output, "publishes zeros while disarmed",
     "disarmed with an error", "a helpful extra",
     [](FaultyLaw& law) {
       auto flying = std::make_shared<bool>(true);
       change_stage(law.step.is_flying, [flying](const auto& then, const Topics& topics) {
         *flying = topics.armed;
         return then(topics);
       });
       also_after(law, [flying](const attest_inputs&, attest_outputs& out) {
         if (*flying || out.actuator_controls_0.published == 0) return;
         for (float& c : out.actuator_controls_0.control) c = 0;
       });
     }},
    {"disarmed-silent", "arming", Stage::output, "publishes no actuators while disarmed",
     "disarmed", "a helpful extra",
     [](FaultyLaw& law) {
       auto armed = std::make_shared<bool>(true);
       change_stage(law.step.is_flying, [armed](const auto& then, const Topics& topics) {
         *armed = topics.armed;
         return then(topics);
       });
       also_after(law, [armed](const attest_inputs&, attest_outputs& out) {
         if (!*armed) out.actuator_controls_0.published = 0;
       });
     }},
    {"armed-is-1", "arming", Stage::arming, "treats only 1 as armed",
     "a true flag with a value other than 1", "flag comparison",
     [](FaultyLaw& law) {
       also_before(
           law, [](attest_inputs& in) { in.actuator_armed.armed = in.actuator_armed.armed == 1; });
     }},
    {"armed-late", "arming", Stage::arming, "uses actuator_armed one tick late", "disarming",
     "one-tick delay",
     [](FaultyLaw& law) {
       also_before(law, [last = std::uint8_t{0}](attest_inputs& in) mutable {
         std::swap(last, in.actuator_armed.armed);
         in.updated |= ATTEST_UPDATED_ACTUATOR_ARMED;
       });
     }},
    {"armed-at-start", "arming", Stage::arming, "assumes armed before the first actuator_armed",
     "no actuator_armed yet", "initial state",
     [](FaultyLaw& law) {
       auto received = std::make_shared<bool>(false);
       also_before(law, [received](attest_inputs& in) {
         *received = *received || (in.updated & ATTEST_UPDATED_ACTUATOR_ARMED) != 0;
       });
       law.step.is_flying = [received](const Topics& topics) {
         return (topics.armed || !*received) && topics.is_rotary_wing;
       };
     }},
    {"fixed-wing-at-start", "arming", Stage::arming,
     "assumes a fixed wing before the first vehicle_status", "no vehicle_status yet",
     "initial state",
     [](FaultyLaw& law) {
       auto received = std::make_shared<bool>(false);
       also_before(law, [received](attest_inputs& in) {
         *received = *received || (in.updated & ATTEST_UPDATED_VEHICLE_STATUS) != 0;
       });
       change_stage(law.step.is_flying, [received](const auto& then, const Topics& topics) {
         return then(topics) && *received;
       });
     }},
    {"status-not-needed", "arming", Stage::output, "publishes before the first vehicle_status",
     "no vehicle_status yet", "initial state",
     [](FaultyLaw& law) {
       also_before(law, [first = true](attest_inputs& in) mutable {
         if (first && (in.updated & ATTEST_UPDATED_VEHICLE_STATUS) == 0) {
           in.updated |= ATTEST_UPDATED_VEHICLE_STATUS;
           in.vehicle_status.is_rotary_wing = 1;
         }
         first = false;
       });
     }},
    {"status-every-step", "arming", Stage::output,
     "publishes only in steps with a new vehicle_status", "a vehicle_status that came once",
     "a latch",
     [](FaultyLaw& law) {
       also_after(law, [](const attest_inputs& in, attest_outputs& out) {
         if ((in.updated & ATTEST_UPDATED_VEHICLE_STATUS) == 0) {
           out.actuator_controls_0.published = 0;
         }
       });
     }},
    {"integrals-with-actuators", "arming", Stage::output,
     "publishes integrals only with the actuators", "no vehicle_status yet",
     "a misplaced condition",
     [](FaultyLaw& law) {
       also_after(law, [](const attest_inputs&, attest_outputs& out) {
         if (out.actuator_controls_0.published == 0) out.mc_att_ctrl_status.published = 0;
       });
     }},
    {"limits-armed-only", "arming", Stage::input, "updates the motor limits only while armed",
     "a limit that changes while disarmed", "a condition added",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         if (in.actuator_armed.armed == 0) {
           in.updated &= ~std::uint32_t{ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS};
         }
       });
     }},
    {"previous-rates-shared", "instances", Stage::d,
     "stores the previous rates in a variable that all instances share", "a second instance",
     "static state",
     [](FaultyLaw& law) {
       // Lives as long as any instance, so that a test vector does not depend on the previous one.
       static std::weak_ptr<Vector> of_living_instances;
       auto prev = of_living_instances.lock();
       if (!prev) of_living_instances = prev = std::make_shared<Vector>(Vector::Zero());
       change_stage(law.rate.derivative,
                    [prev](const auto& then, const Vector&, const Vector& rates, float dt,
                           const RateGains& gains) {
                      const Vector d = then(*prev, rates, dt, gains);
                      *prev = rates;
                      return d;
                    });
     }},
    {"vtol-silent", "arming", Stage::output, "publishes no actuators for a VTOL", "is_vtol",
     "a helpful extra",
     [](FaultyLaw& law) {
       also_after(law, [](const attest_inputs& in, attest_outputs& out) {
         if (in.vehicle_status.is_vtol != 0) out.actuator_controls_0.published = 0;
       });
     }},
    {"setpoint-not-kept", "arming", Stage::input,
     "uses a setpoint only in the step in which it arrives", "a setpoint at 50 Hz", "a latch",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         if ((in.updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) == 0) {
           in.vehicle_attitude_setpoint = {};
           in.vehicle_attitude_setpoint.q_d[0] = 1;
         }
         in.updated |= ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
       });
     }},
    {"setpoint-level-at-start", "arming", Stage::input,
     "assumes a level setpoint before the first one", "no setpoint yet", "initial state",
     [](FaultyLaw& law) {
       also_before(law, [received = false](attest_inputs& in) mutable {
         received = received || (in.updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) != 0;
         if (received) return;
         in.vehicle_attitude_setpoint = {};
         in.vehicle_attitude_setpoint.q_d[0] = 1;
         in.updated |= ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
       });
     }},
};

}  // namespace

std::span<const Fault> arming_faults() { return arming_list; }

}  // namespace attest::faults
