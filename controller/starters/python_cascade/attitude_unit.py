# SPDX-License-Identifier: BSD-3-Clause
"""The attitude unit: attitude to rates setpoint, PX4 v1.14 to v1.18 mc_att_control.

Attitudes rotate the body (FRD) into the world (NED). Rates are in rad/s about the body axes x, y,
z. `attest list --parameters` has the unit of each parameter.
"""

from attitude_law import AttitudeLaw, AttitudeLawOfV118, AttitudeSetpoint
from binary32 import NAN, ZERO, Binary32, is_finite
from messages import PARAMETER_UPDATE, AttitudeInputs, AttitudeOutputs
from parameters import (
    PX4_V114,
    PX4_V115,
    PX4_V116,
    PX4_V117,
    PX4_V118,
    SINCE_V116,
    SINCE_V117,
    Parameters,
)
from rotation import added
from scalar import clamp, microseconds, seconds
from sticks import Sticks, Vehicle

SHORTEST_DT = Binary32(0.0002)  # [s]
LONGEST_DT = Binary32(0.02)
LEAST_HOVER_THRUST = Binary32(0.05)
MOST_HOVER_THRUST = Binary32(0.9)
US_PER_S = Binary32(1e6)
AUTOTUNE_STATES = (3, 6, 9, 13)  # those that move the vehicle: roll, pitch, yaw, test
AUTOTUNE_STATES_BEFORE_V117 = (2, 4, 6, 10)
AUTOTUNE_LASTS_US = 1_000_000

_DEFAULTS = {
    "MC_ROLL_P": 6.5,
    "MC_PITCH_P": 6.5,
    "MC_YAW_P": 2.8,
    "MC_YAW_WEIGHT": 0.4,
    "MC_ROLLRATE_MAX": 220.0,
    "MC_PITCHRATE_MAX": 220.0,
    "MC_YAWRATE_MAX": 200.0,
    "MPC_MAN_TILT_MAX": 35.0,
    "MC_MAN_TILT_TAU": 0.0,
    "MPC_MAN_Y_MAX": 150.0,
    "MPC_MANTHR_MIN": 0.08,
    "MPC_THR_HOVER": 0.5,
    "MPC_THR_MAX": 1.0,
    "MPC_THR_CURVE": 0,
    "MC_AIRMODE": 0,
}
_SINCE_V115 = {"COM_SPOOLUP_TIME": 1.0}
_SINCE_V116 = {**_SINCE_V115, "MPC_MAN_Y_TAU": 0.08}
_SINCE_V117 = {**_SINCE_V116, "MC_ROLL_P": 4.0, "MC_PITCH_P": 4.0, "MAN_DEADZONE": 0.1}
_SINCE_V118 = {**_SINCE_V117, "MC_REF_W_N": 50.0, "MC_REF_FF": 0.0, "MC_REF_FF_MAX": 100.0}
_DEFAULTS_OF = {
    PX4_V114: _DEFAULTS,
    PX4_V115: {**_DEFAULTS, **_SINCE_V115},
    PX4_V116: {**_DEFAULTS, **_SINCE_V116, "MPC_HOLD_DZ": 0.1, "MPC_YAW_EXPO": 0.6},
    PX4_V117: {**_DEFAULTS, **_SINCE_V117},
    PX4_V118: {**_DEFAULTS, **_SINCE_V118},
}


class AttitudeUnit:
    """One instance in its power-on state."""

    MODULE = "attitude_unit"
    INPUTS = AttitudeInputs
    OUTPUTS = AttitudeOutputs

    def __init__(self, profile):
        self.profile = profile
        self.parameters = Parameters(_DEFAULTS_OF[profile])
        self.values = None  # of the parameters, from the first step on
        self.law = AttitudeLawOfV118() if profile == PX4_V118 else AttitudeLaw()
        self.sticks = Sticks(profile)
        self.vehicle = Vehicle()
        self.thrust = (ZERO, ZERO, ZERO)
        self.hover_estimate = NAN
        self.last_sample_us = 0
        self.last_setpoint_us = 0
        self.reset_counter = 0
        self.pending_setpoint = None  # the newest one, until it is latched
        self.has_autotune = False
        self.is_stabilized = self.controls_attitude = False

    def step(self, inputs, outputs):
        """One step of the loop, at each sample of the attitude. Fills `outputs`."""
        self._read_parameters(inputs.updated)
        attitude = inputs.vehicle_attitude
        q = tuple(attitude.q)
        elapsed = seconds(attitude.timestamp_sample, self.last_sample_us)
        dt = clamp(elapsed, SHORTEST_DT, LONGEST_DT)
        self.last_sample_us = attitude.timestamp_sample
        self._note_setpoint(inputs)
        if self.profile == PX4_V114:
            self._follow_setpoint(attitude)
        self._latch_mode(inputs)
        self._latch_vehicle(inputs)
        runs = self.controls_attitude and self.vehicle.flies_as_multicopter()
        uses_sticks = runs and self.is_stabilized
        if uses_sticks:
            self._follow_sticks(inputs, q, dt, outputs.vehicle_attitude_setpoint)
        else:
            if runs or self.profile in SINCE_V116:
                self.sticks.reset_tilt()
            self.sticks.heading.rest(self.vehicle, q)
        if runs:
            if self.profile != PX4_V114:
                self._follow_setpoint(attitude)
            self._publish_rates(inputs, q, outputs.vehicle_rates_setpoint)
        self.sticks.throttle.end_step(self.vehicle, self.values, self.hover_estimate, dt)
        self.sticks.heading.end_step(uses_sticks, self.vehicle)

    def _read_parameters(self, updated):
        values = self.parameters.newly_read(updated & PARAMETER_UPDATE)
        if values:
            self.values = values
            self.law.read(values)
            self.sticks.throttle.read(values, self.hover_estimate)

    def _note_setpoint(self, inputs):
        if inputs.updated & AttitudeInputs.VEHICLE_ATTITUDE_SETPOINT:
            sample = inputs.vehicle_attitude_setpoint
            self.pending_setpoint = AttitudeSetpoint(
                sample.timestamp,
                tuple(sample.q_d),
                sample.yaw_sp_move_rate,
                tuple(sample.thrust_body),
            )

    def _follow_setpoint(self, attitude):
        """Takes the newest setpoint, and turns it with a reset of the estimator."""
        if self.pending_setpoint and self.pending_setpoint.time_us > self.last_setpoint_us:
            self._follow(self.pending_setpoint)
        self.pending_setpoint = None
        if attitude.quat_reset_counter != self.reset_counter:
            self.reset_counter = attitude.quat_reset_counter
            rotation = tuple(attitude.delta_q_reset)
            self.sticks.heading.turn(rotation)
            if attitude.timestamp > self.last_setpoint_us:
                self.law.turn(rotation)

    def _follow(self, setpoint):
        is_first = self.last_setpoint_us == 0
        elapsed = None if is_first else seconds(setpoint.time_us, self.last_setpoint_us)
        self.law.follow(setpoint, elapsed)
        self.thrust = setpoint.thrust_body
        self.last_setpoint_us = setpoint.time_us

    def _latch_mode(self, inputs):
        if inputs.updated & AttitudeInputs.VEHICLE_CONTROL_MODE:
            mode = inputs.vehicle_control_mode
            self.controls_attitude = mode.flag_control_attitude_enabled != 0
            self.is_stabilized = mode.flag_control_manual_enabled != 0 and not (
                mode.flag_control_altitude_enabled
                or mode.flag_control_velocity_enabled
                or mode.flag_control_position_enabled
            )
        if inputs.updated & AttitudeInputs.HOVER_THRUST_ESTIMATE and self.profile in SINCE_V116:
            hover = inputs.hover_thrust_estimate
            self.hover_estimate = self.values["MPC_THR_HOVER"]
            if hover.valid:
                self.hover_estimate = clamp(
                    hover.hover_thrust, LEAST_HOVER_THRUST, MOST_HOVER_THRUST
                )
        if inputs.updated & AttitudeInputs.AUTOTUNE_ATTITUDE_CONTROL_STATUS:
            self.has_autotune = True

    def _latch_vehicle(self, inputs):
        updated, vehicle = inputs.updated, self.vehicle
        if updated & AttitudeInputs.VEHICLE_STATUS:
            status = inputs.vehicle_status
            vehicle.is_rotary_wing = status.is_rotary_wing != 0
            vehicle.is_vtol = status.is_vtol != 0
            vehicle.is_tailsitter = status.is_vtol_tailsitter != 0
            vehicle.is_in_transition = status.in_transition_mode != 0
            if "COM_SPOOLUP_TIME" in self.values:
                spool_up_us = self.values["COM_SPOOLUP_TIME"] * US_PER_S
                armed_us = microseconds(inputs.timestamp, status.armed_time)
                vehicle.has_spooled_up = status.armed != 0 and armed_us > spool_up_us
        if updated & AttitudeInputs.VEHICLE_LAND_DETECTED:
            vehicle.is_landed = inputs.vehicle_land_detected.landed != 0
        if updated & AttitudeInputs.VEHICLE_LOCAL_POSITION:
            position = inputs.vehicle_local_position
            if self.profile != PX4_V118:  # which does not read it
                vehicle.has_good_heading = position.heading_good_for_control != 0
            vehicle.unaided_heading = position.unaided_heading

    def _follow_sticks(self, inputs, q, dt, out):
        """Publishes a setpoint, which the unit also receives as a new sample on the topic."""
        sticks = inputs.manual_control_setpoint
        made = self.sticks.setpoint(sticks, self.vehicle, q, self.values, dt)
        self.pending_setpoint = AttitudeSetpoint(inputs.timestamp, *made)
        if self.profile == PX4_V114:
            self._follow(self.pending_setpoint)  # so the next step drops the sample
        out.q_d, out.yaw_sp_move_rate, out.thrust_body = made
        out.published = 1

    def _publish_rates(self, inputs, q, out):
        rates = self.law.rates(q)
        autotune = inputs.autotune_attitude_control_status
        age_us = (inputs.timestamp - autotune.timestamp) % 2**64
        is_new = self.has_autotune and age_us < AUTOTUNE_LASTS_US
        is_since_v117 = self.profile in SINCE_V117
        states = AUTOTUNE_STATES if is_since_v117 else AUTOTUNE_STATES_BEFORE_V117
        if is_new and autotune.state in states:
            rates = added(rates, autotune.rate_sp)
        out.roll, out.pitch, out.yaw = rates
        out.thrust_body = self.thrust
        out.published = 1
