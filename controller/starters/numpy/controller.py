# SPDX-License-Identifier: BSD-3-Clause
"""One step of the controller: topics, modes, and what is published. All state of an instance."""

import numpy as np

from law import (
    DEFAULTS,
    Gains,
    attitude_error,
    limited_rates,
    new_integrals,
    throttle_attenuation,
)
from messages import INPUTS, TOPICS
from tailsitter import Recovery
from vector import ONE, ZERO, clamp, f32, vector

PROFILES = ("px4-v1.5.5", "px4-v1.3.4")

US_IN_S = f32(1000000)
DT_MIN, DT_MAX = f32(0.002), f32(0.02)  # [s]
ACRO_THRUST_MAX = f32(0.9)
BIT = {topic: 1 << index for index, topic in enumerate(TOPICS)}
TOPICS_OF_EACH_STEP = TOPICS[2:8]  # the two setpoints are copied in the modes that need them


class Controller:
    def __init__(self, profile):
        self.is_v134 = profile == "px4-v1.3.4"
        self.parameters = {name: f32(value) for name, value in DEFAULTS.items()}
        self.gains = None  # of the parameters at the first step or the last parameter_update
        self.recovery = None
        self.latched = np.zeros(1, INPUTS)[0]  # the copies of the topics
        self.latched["vehicle_status"]["is_rotary_wing"] = 1
        self.pending = 0  # bits of the topics with a sample that is not copied yet
        self.is_vtol = None  # until the first vehicle_status
        self.last_timestamp = 0
        self.integrals = vector(0, 0, 0)
        self.previous_rates = vector(0, 0, 0)
        self.previous_rates_sp = vector(0, 0, 0)

    def set_parameter(self, name, value):
        """Returns False if there is no such parameter."""
        if name not in self.parameters:
            return False
        self.parameters[name] = f32(value)
        return True

    def step(self, inputs, outputs):
        """`inputs` is a record of INPUTS, `outputs` a record of OUTPUTS filled with zeros."""
        self.pending |= int(inputs["updated"])
        self.update_parameters()
        dt = self.time_step(int(inputs["timestamp"]))
        self.latch_topics(inputs)
        rates_sp, thrust = self.control_attitude(inputs, outputs["vehicle_rates_setpoint"])
        if self.latched["vehicle_control_mode"]["flag_control_rates_enabled"]:
            controls = self.control_rates(inputs["control_state"]["rates"], rates_sp, thrust, dt)
            self.publish_controls(controls, thrust, outputs["actuator_controls_0"])
            status = outputs["mc_att_ctrl_status"]
            status["rate_integrals"] = self.integrals
            status["published"] = 1

    def update_parameters(self):
        if self.gains is None:
            self.gains = Gains(self.parameters)
            if self.parameters["VT_TYPE"] == ZERO and self.parameters["VT_OPT_RECOV_EN"] != ZERO:
                self.recovery = Recovery()
        elif self.pending & BIT["parameter_update"]:
            self.gains = Gains(self.parameters)
        self.pending &= ~BIT["parameter_update"]

    def time_step(self, timestamp):
        """dt [s]. The first one counts from time 0, so it is usually clamped to DT_MAX."""
        dt = f32(timestamp - self.last_timestamp) / US_IN_S
        self.last_timestamp = timestamp
        return f32(clamp(dt, DT_MIN, DT_MAX))

    def latch(self, topic, inputs):
        if self.pending & BIT[topic]:
            self.latched[topic] = inputs[topic]
            self.pending &= ~BIT[topic]

    def latch_topics(self, inputs):
        if self.is_vtol is None and self.pending & BIT["vehicle_status"]:
            self.is_vtol = bool(inputs["vehicle_status"]["is_vtol"])
        for topic in TOPICS_OF_EACH_STEP:
            self.latch(topic, inputs)
        mode = self.latched["vehicle_control_mode"]
        sticks = self.latched["manual_control_setpoint"]
        threshold = self.gains.rattitude_threshold
        if mode["flag_control_rattitude_enabled"] and (
            abs(sticks["y"]) > threshold or abs(sticks["x"]) > threshold
        ):
            # Cleared in the copy, so it stays cleared until the next vehicle_control_mode.
            mode["flag_control_attitude_enabled"] = 0

    def control_attitude(self, inputs, output):
        """Rates setpoint [rad/s] and thrust of the present mode."""
        mode = self.latched["vehicle_control_mode"]
        if mode["flag_control_attitude_enabled"]:
            self.latch("vehicle_attitude_setpoint", inputs)
            setpoint = self.latched["vehicle_attitude_setpoint"]
            rates_sp = self.rates_of_attitude(inputs["control_state"]["q"], setpoint, mode)
            thrust = setpoint["thrust"]
        elif mode["flag_control_manual_enabled"]:
            sticks = self.latched["manual_control_setpoint"]
            rates_sp = vector(sticks["y"], -sticks["x"], sticks["r"]) * self.gains.acro_rate_max
            thrust = sticks["z"] if sticks["z"] < ACRO_THRUST_MAX else ACRO_THRUST_MAX
        else:
            self.latch("vehicle_rates_setpoint", inputs)
            copy = self.latched["vehicle_rates_setpoint"]
            return copy["rates"], copy["thrust"]
        self.publish_rates(rates_sp, thrust, output)
        return rates_sp, thrust

    def rates_of_attitude(self, q, setpoint, mode):
        if self.recovery:
            return self.recovery.rates(q, setpoint, self.gains)
        error, yaw_weight = attitude_error(q, setpoint["q_d"])
        rates_sp, is_weather_vane = limited_rates(
            error, yaw_weight, setpoint, mode, self.gains, self.is_v134
        )
        if is_weather_vane:
            self.integrals[2] = ZERO
        return rates_sp

    def publish_rates(self, rates_sp, thrust, output):
        copy = self.latched["vehicle_rates_setpoint"]
        copy["rates"], copy["thrust"] = rates_sp, thrust
        if self.is_vtol is None:
            return  # the topic is not selected yet
        output["rates"], output["thrust"] = rates_sp, thrust
        output["published"] = 1
        if not self.is_vtol:
            # This newer sample replaces a pending external one on the same topic. A VTOL publishes
            # on a virtual topic.
            self.pending &= ~BIT["vehicle_rates_setpoint"]

    def control_rates(self, rates, rates_sp, thrust, dt):
        """Returns the roll, pitch and yaw controls, and updates the integrals."""
        is_armed = self.latched["actuator_armed"]["armed"]
        if not is_armed or not self.latched["vehicle_status"]["is_rotary_wing"]:
            self.integrals = vector(0, 0, 0)
        gains = self.gains
        error = rates_sp - rates
        if self.is_v134:
            attenuation = ONE
            feed_forward = gains.rate_ff * (rates_sp - self.previous_rates_sp) / dt
        else:
            thrust_copy = self.latched["vehicle_rates_setpoint"]["thrust"]
            attenuation = throttle_attenuation(thrust_copy, gains)
            feed_forward = gains.rate_ff * rates_sp
        p = gains.rate_p * (error * attenuation)
        d = gains.rate_d * (self.previous_rates - rates) / dt
        controls = p + d + self.integrals + feed_forward
        self.previous_rates = rates.copy()  # copies, because these may be views of a topic
        self.previous_rates_sp = rates_sp.copy()
        self.integrals = new_integrals(
            self.integrals,
            controls,
            error,
            dt,
            thrust,
            self.latched["multirotor_motor_limits"],
            gains,
            self.is_v134,
        )
        return controls

    def publish_controls(self, controls, thrust, output):
        if self.is_vtol is None or self.gains.breaks_circuit:
            return
        roll_pitch_yaw_thrust = np.append(controls, thrust)
        is_finite = np.isfinite(roll_pitch_yaw_thrust)
        output["control"][:4] = np.where(is_finite, roll_pitch_yaw_thrust, ZERO)
        if not self.is_v134:
            output["control"][7] = self.latched["vehicle_attitude_setpoint"]["landing_gear"]
            scale = self.latched["battery_status"]["scale"]
            if self.gains.scales_with_battery and scale > ZERO:
                output["control"][:4] *= scale
        output["published"] = 1
