# SPDX-License-Identifier: BSD-3-Clause
"""The rate unit: rates of the body to torque and thrust, PX4 v1.14 to v1.18 mc_rate_control.

Vectors (roll, pitch, yaw) are about the body axes x, y, z (FRD). Rates are in rad/s; torque, thrust
and integrals have no unit. `attest list --parameters` has the unit of each parameter.
"""

from binary32 import EPSILON, HALF, ONE, TWO_PI, ZERO, Binary32, is_finite
from messages import PARAMETER_UPDATE, RateInputs, RateOutputs
from parameters import AXES, PX4_V114, SINCE_V116, Parameters
from scalar import LowPass, clamp, larger, radians, seconds, smaller, superexpo

SHORTEST_DT = Binary32(0.000125)  # [s]
LONGEST_DT = Binary32(0.02)
RATE_ERROR_OF_NO_INTEGRAL = Binary32(6.98131704)  # 400 deg/s

_DEFAULTS = {
    **{f"MC_{axis}RATE_P": value for axis, value in zip(AXES, (0.15, 0.15, 0.2))},
    **{f"MC_{axis}RATE_I": value for axis, value in zip(AXES, (0.2, 0.2, 0.1))},
    **{f"MC_{axis}RATE_D": value for axis, value in zip(AXES, (0.003, 0.003, 0.0))},
    **{f"MC_{axis}RATE_FF": 0.0 for axis in AXES},
    **{f"MC_{axis}RATE_K": 1.0 for axis in AXES},
    **{f"MC_{axis}R_INT_LIM": 0.3 for axis in "RPY"},
    **{f"MC_ACRO_{axis}_MAX": 100.0 for axis in "RPY"},
    "MC_ACRO_EXPO": 0.0,
    "MC_ACRO_EXPO_Y": 0.0,
    "MC_ACRO_SUPEXPO": 0.0,
    "MC_ACRO_SUPEXPOY": 0.0,
    "MC_BAT_SCALE_EN": 0,
}
_DEFAULTS_OF_V114 = {
    "MC_ACRO_R_MAX": 720.0,
    "MC_ACRO_P_MAX": 720.0,
    "MC_ACRO_Y_MAX": 540.0,
    "MC_ACRO_EXPO": 0.69,
    "MC_ACRO_EXPO_Y": 0.69,
    "MC_ACRO_SUPEXPO": 0.7,
    "MC_ACRO_SUPEXPOY": 0.7,
}
_DEFAULTS_SINCE_V116 = {"MC_YAW_TQ_CUTOFF": 2.0}


def default_parameters(profile):
    if profile == PX4_V114:
        return {**_DEFAULTS, **_DEFAULTS_OF_V114}
    return {**_DEFAULTS, **_DEFAULTS_SINCE_V116} if profile in SINCE_V116 else _DEFAULTS


class RateLaw:
    """Rates and their setpoint to torque: PID with feed-forward."""

    def __init__(self):
        self.integral = (ZERO, ZERO, ZERO)
        self.saturated_up = self.saturated_down = (False, False, False)

    def read(self, parameters):
        def by_axis(suffix):
            return tuple(parameters[f"MC_{axis}RATE_{suffix}"] for axis in AXES)

        def scaled(gains):
            return tuple(k * gain for k, gain in zip(by_axis("K"), gains))

        self.p = scaled(by_axis("P"))
        self.i = scaled(by_axis("I"))
        self.d = scaled(by_axis("D"))
        self.feed_forward = by_axis("FF")
        self.limits = tuple(parameters[f"MC_{axis}R_INT_LIM"] for axis in "RPY")

    def torque(self, rates, setpoint, acceleration, dt, is_landed):
        """Returns the torque, then updates the integral. `acceleration` in rad/s^2."""
        error = tuple(setpoint[i] - rates[i] for i in range(3))
        torque = tuple(
            self.p[i] * error[i]
            + self.integral[i]
            - self.d[i] * acceleration[i]
            + self.feed_forward[i] * setpoint[i]
            for i in range(3)
        )
        if not is_landed:
            self.integral = tuple(self._integrated(i, error[i], dt) for i in range(3))
        return torque

    def _integrated(self, i, error, dt):
        """A saturated axis does not integrate further into its saturation."""
        if self.saturated_up[i]:
            error = smaller(error, ZERO)
        if self.saturated_down[i]:
            error = larger(error, ZERO)
        share = error / RATE_ERROR_OF_NO_INTEGRAL  # less of a large error, as in a flip
        share = larger(ZERO, ONE - share * share)
        integral = self.integral[i] + share * self.i[i] * error * dt
        if not is_finite(integral):
            return self.integral[i]
        return clamp(integral, -self.limits[i], self.limits[i])


class RateUnit:
    """One instance in its power-on state."""

    MODULE = "rate_unit"
    INPUTS = RateInputs
    OUTPUTS = RateOutputs

    def __init__(self, profile):
        self.parameters = Parameters(default_parameters(profile))
        self.law = RateLaw()
        self.yaw_filter = LowPass() if profile in SINCE_V116 else None
        self.last_sample_us = 0
        self.pending = 0  # bits of the topics that were published and are not yet latched
        self.own_setpoint = None  # rates and thrust of the sticks, while it is pending

        self.setpoint = self.thrust = (ZERO, ZERO, ZERO)
        self.is_armed = self.is_manual = False
        self.controls_attitude = self.controls_rates = False
        self.is_rotary_wing = self.is_landed = True
        self.battery_scale = ZERO

    def step(self, inputs, outputs):
        """One step of the loop, at each sample of the rates. Fills `outputs`."""
        self._read_parameters(inputs.updated)
        velocity = inputs.vehicle_angular_velocity
        elapsed = seconds(velocity.timestamp_sample, self.last_sample_us)
        dt = clamp(elapsed, SHORTEST_DT, LONGEST_DT)
        self.last_sample_us = velocity.timestamp_sample
        self._latch_vehicle(inputs)
        if self.is_manual and not self.controls_attitude:
            if self._take(RateInputs.MANUAL_CONTROL_SETPOINT):
                self._follow_sticks(inputs.manual_control_setpoint, outputs)
        elif self._take(RateInputs.VEHICLE_RATES_SETPOINT):
            self._follow_setpoint(inputs.vehicle_rates_setpoint, velocity.xyz)
        if not self.controls_rates:
            return
        if not self.is_armed or not self.is_rotary_wing:
            self.law.integral = (ZERO, ZERO, ZERO)
        if self._take(RateInputs.CONTROL_ALLOCATOR_STATUS):
            self._latch_saturation(inputs.control_allocator_status)
        torque = self.law.torque(
            velocity.xyz, self.setpoint, velocity.xyz_derivative, dt, self.is_landed
        )
        if self.yaw_filter:
            torque = (*torque[:2], self.yaw_filter.update(self.yaw_filter_tau, dt, torque[2]))
        self._publish(torque, inputs, outputs)

    def _take(self, bit):
        """Whether the topic was pending. Afterwards it is not."""
        is_pending = self.pending & bit
        self.pending &= ~bit
        return is_pending

    def _read_parameters(self, updated):
        p = self.parameters.newly_read(updated & PARAMETER_UPDATE)
        if not p:
            return
        self.law.read(p)
        self.acro_max = tuple(radians(p[f"MC_ACRO_{axis}_MAX"]) for axis in "RPY")
        self.acro_expo = (p["MC_ACRO_EXPO"], p["MC_ACRO_SUPEXPO"])
        self.acro_expo_yaw = (p["MC_ACRO_EXPO_Y"], p["MC_ACRO_SUPEXPOY"])
        self.scales_by_battery = p["MC_BAT_SCALE_EN"] != ZERO
        if self.yaw_filter:
            cutoff = p["MC_YAW_TQ_CUTOFF"]
            self.yaw_filter_tau = ONE / (TWO_PI * cutoff) if cutoff > EPSILON else ZERO

    def _latch_vehicle(self, inputs):
        self.pending |= inputs.updated
        if inputs.updated & RateInputs.VEHICLE_RATES_SETPOINT:
            self.own_setpoint = None  # the external sample is newer
        if self._take(RateInputs.VEHICLE_CONTROL_MODE):
            mode = inputs.vehicle_control_mode
            self.is_armed = mode.flag_armed != 0
            self.is_manual = mode.flag_control_manual_enabled != 0
            self.controls_attitude = mode.flag_control_attitude_enabled != 0
            self.controls_rates = mode.flag_control_rates_enabled != 0
        if self._take(RateInputs.VEHICLE_LAND_DETECTED):
            land = inputs.vehicle_land_detected
            self.is_landed = land.landed != 0 or land.maybe_landed != 0
        if self._take(RateInputs.VEHICLE_STATUS):
            self.is_rotary_wing = inputs.vehicle_status.is_rotary_wing != 0

    def _follow_sticks(self, sticks, outputs):
        """Acro: the sticks are rates. The unit later receives the sample that it publishes here."""
        curves = (
            superexpo(sticks.roll, *self.acro_expo),
            superexpo(-sticks.pitch, *self.acro_expo),
            superexpo(sticks.yaw, *self.acro_expo_yaw),
        )
        self.setpoint = tuple(curve * most for curve, most in zip(curves, self.acro_max))
        self.thrust = (ZERO, ZERO, -(sticks.throttle + ONE) * HALF)
        self.own_setpoint = (self.setpoint, self.thrust)
        self.pending |= RateInputs.VEHICLE_RATES_SETPOINT
        out = outputs.vehicle_rates_setpoint
        out.roll, out.pitch, out.yaw = self.setpoint
        out.thrust_body = self.thrust
        out.published = 1

    def _follow_setpoint(self, sample, rates):
        """An axis whose setpoint is not finite holds the rate measured now."""
        wanted, self.thrust = self.own_setpoint or (
            (sample.roll, sample.pitch, sample.yaw),
            tuple(sample.thrust_body),
        )
        self.own_setpoint = None
        self.setpoint = tuple(
            rate if is_finite(rate) else now for rate, now in zip(wanted, rates)
        )

    def _latch_saturation(self, status):
        torque = status.unallocated_torque
        is_short = not status.torque_setpoint_achieved
        self.law.saturated_up = tuple(is_short and short > EPSILON for short in torque)
        self.law.saturated_down = tuple(is_short and short < -EPSILON for short in torque)

    def _publish(self, torque, inputs, outputs):
        status = outputs.rate_ctrl_status
        status.rollspeed_integ, status.pitchspeed_integ, status.yawspeed_integ = self.law.integral
        status.published = 1
        torque = tuple(axis if is_finite(axis) else ZERO for axis in torque)
        thrust = self.thrust
        if self.scales_by_battery:
            self._latch_battery(inputs.battery_status)
            if self.battery_scale > ZERO:
                torque = self._scaled(torque)
                thrust = self._scaled(thrust)
        outputs.vehicle_torque_setpoint.xyz = torque
        outputs.vehicle_torque_setpoint.published = 1
        outputs.vehicle_thrust_setpoint.xyz = thrust
        outputs.vehicle_thrust_setpoint.published = 1

    def _latch_battery(self, battery):
        is_new = self._take(RateInputs.BATTERY_STATUS)
        if is_new and battery.connected and battery.scale > ZERO:
            self.battery_scale = battery.scale

    def _scaled(self, values):
        return tuple(clamp(value * self.battery_scale, -ONE, ONE) for value in values)
