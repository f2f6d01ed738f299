# SPDX-License-Identifier: BSD-3-Clause
"""One step of the controller: topics, modes, and what is published.

`attest_unit.h` explains the signals, and when a topic is latched.
"""

from typing import NamedTuple, Tuple

from law import (
    PX4_V134,
    PX4_V155,
    MIN_TAKEOFF_THRUST,
    Gains,
    attitude_law,
    default_parameters,
    finite_or_zero,
    integrate,
    rate_law,
    thrust_attenuation,
)
from tailsitter import TailsitterRecovery
from vector import binary32, clamp

PROFILES = (PX4_V155, PX4_V134)

# The bits of Inputs.updated.
VEHICLE_ATTITUDE_SETPOINT = 1 << 0
VEHICLE_RATES_SETPOINT = 1 << 1
MANUAL_CONTROL_SETPOINT = 1 << 2
VEHICLE_CONTROL_MODE = 1 << 3
ACTUATOR_ARMED = 1 << 4
VEHICLE_STATUS = 1 << 5
MULTIROTOR_MOTOR_LIMITS = 1 << 6
BATTERY_STATUS = 1 << 7
PARAMETER_UPDATE = 1 << 8

# The law's limits of dt. A loop faster than 500 Hz also uses MIN_DT_S: a quirk of the law.
MIN_DT_S = 0.002
MAX_DT_S = 0.02
MAX_ACRO_THRUST = binary32(0.9)


class AttitudeSetpoint(NamedTuple):
    q_d: Tuple[float, ...]  # body FRD to world NED
    thrust: float  # 0 .. 1
    yaw_sp_move_rate: float  # rad/s
    landing_gear: float
    disable_mc_yaw_control: int


class RatesSetpoint(NamedTuple):
    """Rates about the body axes [rad/s], and the thrust 0 .. 1."""

    roll: float
    pitch: float
    yaw: float
    thrust: float


class ManualControl(NamedTuple):
    """The sticks: x forward, y right, z throttle, r yaw."""

    x: float
    y: float
    z: float
    r: float


class ControlMode(NamedTuple):
    """Flags: any value but zero is true."""

    manual: int
    auto: int
    rates: int
    attitude: int
    rattitude: int
    velocity: int


class MotorLimits(NamedTuple):
    """Flags: any value but zero is true."""

    lower: int
    upper: int
    yaw: int


class Inputs(NamedTuple):
    """Each topic is a sequence of the values of its class above, in the same order."""

    timestamp_us: int
    updated: int
    q: Tuple[float, ...]  # body FRD to world NED
    rates: Tuple[float, ...]  # of the body [rad/s]
    attitude_setpoint: tuple
    rates_setpoint: tuple
    manual_control: tuple
    battery_scale: float
    control_mode: tuple
    armed: int
    is_rotary_wing: int
    is_vtol: int
    motor_limits: tuple


class Outputs(NamedTuple):
    """The values of a topic that is not published are ignored."""

    rates_setpoint: Tuple[float, ...]
    rates_setpoint_published: bool
    controls: Tuple[float, ...]  # the 8 of actuator_controls_0
    controls_published: bool
    integrals: Tuple[float, ...]
    integrals_published: bool


class Controller:
    """One instance in its power-on state. All state of the law is here."""

    def __init__(self, profile):
        self.is_v134 = profile == PX4_V134
        self.parameters = default_parameters(profile)
        self.gains = None  # from the first step on
        self.recovery = None  # of a tailsitter that uses it: from the first step on

        self.attitude_setpoint = AttitudeSetpoint((0.0,) * 4, 0.0, 0.0, 0.0, 0)
        self.rates_setpoint = RatesSetpoint(0.0, 0.0, 0.0, 0.0)
        self.manual_control = ManualControl(0.0, 0.0, 0.0, 0.0)
        self.mode = ControlMode(0, 0, 0, 0, 0, 0)
        self.motor_limits = MotorLimits(0, 0, 0)
        self.battery_scale = 0.0
        self.armed = 0
        self.is_rotary_wing = 1
        self.has_vehicle_status = False
        self.is_vtol = False  # of the first vehicle_status
        self.pending = 0  # bits of topics that were published and not yet latched

        self.last_timestamp_us = 0
        self.rates_prev = (0.0, 0.0, 0.0)
        self.rates_sp_prev = (0.0, 0.0, 0.0)
        self.integrals = (0.0, 0.0, 0.0)

    def set_parameter(self, name, value):
        """Stores the value. Returns False if the profile has no such parameter."""
        if name not in self.parameters:
            return False
        self.parameters[name] = value
        return True

    def step(self, inputs):
        """One step of the loop, at each sample of the attitude and the rates. Returns Outputs."""
        dt = clamp((inputs.timestamp_us - self.last_timestamp_us) / 1e6, MIN_DT_S, MAX_DT_S)
        self.last_timestamp_us = inputs.timestamp_us
        self._read_parameters(inputs)
        self._latch(inputs)
        rates_sp, thrust, publish = self._outer_loop(inputs)
        rates_published = publish and self.has_vehicle_status
        if rates_published and not self.is_vtol:
            # This newer sample replaces a pending external one. A VTOL publishes on another topic.
            self.pending &= ~VEHICLE_RATES_SETPOINT
        if not self.mode.rates:
            return Outputs(
                self.rates_setpoint, rates_published, (0.0,) * 8, False, self.integrals, False
            )
        u = self._rate_loop(inputs.rates, rates_sp, thrust, dt)
        return Outputs(
            self.rates_setpoint,
            rates_published,
            self._controls(u, thrust),
            self.has_vehicle_status and self.gains.publish_actuators,
            self.integrals,
            True,
        )

    def _read_parameters(self, inputs):
        if self.gains is None:
            p = self.parameters
            if p["VT_TYPE"] == 0.0 and p["VT_OPT_RECOV_EN"] != 0.0:
                self.recovery = TailsitterRecovery()  # decided once
        elif not inputs.updated & PARAMETER_UPDATE:
            return
        self.gains = Gains(self.parameters)

    def _latch(self, inputs):
        """Copies the topics that every mode reads; the outer loop copies the two setpoints."""
        updated = inputs.updated
        self.pending |= updated & (VEHICLE_ATTITUDE_SETPOINT | VEHICLE_RATES_SETPOINT)
        if updated & MANUAL_CONTROL_SETPOINT:
            self.manual_control = ManualControl(*inputs.manual_control)
        if updated & VEHICLE_CONTROL_MODE:
            self.mode = ControlMode(*inputs.control_mode)
        if updated & ACTUATOR_ARMED:
            self.armed = inputs.armed
        if updated & VEHICLE_STATUS:
            self.is_rotary_wing = inputs.is_rotary_wing
            if not self.has_vehicle_status:
                self.has_vehicle_status = True
                self.is_vtol = inputs.is_vtol != 0
        if updated & MULTIROTOR_MOTOR_LIMITS:
            self.motor_limits = MotorLimits(*inputs.motor_limits)
        if updated & BATTERY_STATUS:
            self.battery_scale = inputs.battery_scale

    def _outer_loop(self, inputs):
        """The rates setpoint in the body [rad/s], the thrust, and whether to publish them."""
        manual = self.manual_control
        if self.mode.rattitude and self.mode.attitude:
            threshold = self.gains.rattitude_threshold
            if abs(manual.y) > threshold or abs(manual.x) > threshold:
                # Cleared in the copy, so it stays cleared until the next sample of the topic.
                self.mode = self.mode._replace(attitude=0)
        if self.mode.attitude:
            rates_sp, thrust = self._attitude_mode(inputs)
        elif self.mode.manual:
            roll_max, pitch_max, yaw_max = self.gains.acro_rate_max
            rates_sp = (manual.y * roll_max, -manual.x * pitch_max, manual.r * yaw_max)
            thrust = manual.z if manual.z < MAX_ACRO_THRUST else MAX_ACRO_THRUST
        else:
            if self.pending & VEHICLE_RATES_SETPOINT:
                self.pending &= ~VEHICLE_RATES_SETPOINT
                self.rates_setpoint = RatesSetpoint(*inputs.rates_setpoint)
            return self.rates_setpoint[:3], self.rates_setpoint.thrust, False
        self.rates_setpoint = RatesSetpoint(*rates_sp, thrust)
        return rates_sp, thrust, True

    def _attitude_mode(self, inputs):
        if self.pending & VEHICLE_ATTITUDE_SETPOINT:
            self.pending &= ~VEHICLE_ATTITUDE_SETPOINT
            self.attitude_setpoint = AttitudeSetpoint(*inputs.attitude_setpoint)
        setpoint = self.attitude_setpoint
        if self.recovery:
            return self.recovery.rates_setpoint(inputs.q, setpoint, self.gains), setpoint.thrust
        mode = self.mode
        is_auto = not mode.manual and (mode.velocity or (mode.auto and not self.is_v134))
        rate_max = self.gains.auto_rate_max if is_auto else self.gains.rate_max
        weathervane = is_auto and setpoint.disable_mc_yaw_control
        if weathervane:
            self.integrals = (self.integrals[0], self.integrals[1], 0.0)
        rates_sp = attitude_law(
            inputs.q, setpoint, self.gains, rate_max, weathervane, self.is_v134
        )
        return rates_sp, setpoint.thrust

    def _rate_loop(self, rates, rates_sp, thrust, dt):
        """Returns the controls (roll, pitch, yaw), and updates the integrals."""
        if not self.armed or not self.is_rotary_wing:
            self.integrals = (0.0, 0.0, 0.0)
        feed_forward = rates_sp
        if self.is_v134:
            before = self.rates_sp_prev
            feed_forward = tuple((rates_sp[i] - before[i]) / dt for i in (0, 1, 2))
        attenuation = thrust_attenuation(self.rates_setpoint.thrust, self.gains)
        u = rate_law(
            rates, self.rates_prev, rates_sp, feed_forward, attenuation, self.integrals,
            self.gains, dt,
        )
        self.rates_prev = rates
        self.rates_sp_prev = rates_sp
        limits = self.motor_limits
        if thrust > MIN_TAKEOFF_THRUST and not limits.lower and not limits.upper:
            error = (rates_sp[0] - rates[0], rates_sp[1] - rates[1], rates_sp[2] - rates[2])
            yaw_is_saturated = limits.yaw and not self.is_v134
            self.integrals = integrate(
                self.integrals, u, error, thrust, yaw_is_saturated, self.gains, dt
            )
        return u

    def _controls(self, u, thrust):
        """The 8 values of actuator_controls_0."""
        controls = [finite_or_zero(u[0]), finite_or_zero(u[1]), finite_or_zero(u[2])]
        controls.append(finite_or_zero(thrust))
        if self.gains.scale_by_battery and self.battery_scale > 0.0:
            controls = [control * self.battery_scale for control in controls]
        landing_gear = 0.0 if self.is_v134 else self.attitude_setpoint.landing_gear
        return (*controls, 0.0, 0.0, 0.0, landing_gear)
