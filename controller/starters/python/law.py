# SPDX-License-Identifier: BSD-3-Clause
"""The two loops of PX4 v1.5.5 and v1.3.4 mc_att_control, as functions of their arguments.

World is NED, body is FRD. Vectors (roll, pitch, yaw) are about the body axes x, y, z. Angles are
in rad, rates in rad/s; controls, thrust and integrals have no unit. The unit of each parameter is
in the output of `attest list --parameters`.
"""

import math

from vector import (
    binary32,
    clamp,
    column,
    cross,
    divide,
    dot,
    is_finite,
    quaternion_of_matrix,
    rotation_matrix,
    transposed_times,
)

PX4_V155 = "px4-v1.5.5"
PX4_V134 = "px4-v1.3.4"

# A vehicle with less thrust may stand on the ground: its integrals would grow without an effect.
MIN_TAKEOFF_THRUST = binary32(0.2)
INTEGRAL_LIMIT = binary32(0.3)

_DEFAULTS_OF_BOTH = {
    "MC_ROLL_TC": 0.2,
    "MC_PITCH_TC": 0.2,
    "MC_ROLL_P": 6.5,
    "MC_PITCH_P": 6.5,
    "MC_YAW_P": 2.8,
    "MC_YAW_FF": 0.5,
    "MC_ROLLRATE_P": 0.15,
    "MC_ROLLRATE_I": 0.05,
    "MC_ROLLRATE_D": 0.003,
    "MC_ROLLRATE_FF": 0.0,
    "MC_PITCHRATE_P": 0.15,
    "MC_PITCHRATE_I": 0.05,
    "MC_PITCHRATE_D": 0.003,
    "MC_PITCHRATE_FF": 0.0,
    "MC_YAWRATE_P": 0.2,
    "MC_YAWRATE_I": 0.1,
    "MC_YAWRATE_D": 0.0,
    "MC_YAWRATE_FF": 0.0,
    "MC_ROLLRATE_MAX": 220.0,
    "MC_PITCHRATE_MAX": 220.0,
    "MC_YAWRATE_MAX": 200.0,
    "MC_YAWRAUTO_MAX": 45.0,
    "MC_ACRO_R_MAX": 360.0,
    "MC_ACRO_P_MAX": 360.0,
    "MC_ACRO_Y_MAX": 360.0,
    "MC_RATT_TH": 1.0,
    "VT_WV_YAWR_SCL": 0.15,
    "VT_TYPE": 0.0,
    "VT_OPT_RECOV_EN": 0.0,
    "CBRK_RATE_CTRL": 0.0,
}
_DEFAULTS_OF_V155 = {"MC_TPA_BREAK": 1.0, "MC_TPA_SLOPE": 1.0, "MC_BAT_SCALE_EN": 0.0}


def default_parameters(profile):
    """The parameters of a profile by name. All are floats, the integer ones too."""
    defaults = dict(_DEFAULTS_OF_BOTH)
    if profile == PX4_V155:
        defaults.update(_DEFAULTS_OF_V155)
    return {name: binary32(value) for name, value in defaults.items()}


class Gains:
    """Gains and limits, computed from the parameters. Tuples are (roll, pitch, yaw), in rad/s."""

    def __init__(self, parameters):
        p = parameters
        roll_scale = divide(binary32(0.2), p["MC_ROLL_TC"])
        pitch_scale = divide(binary32(0.2), p["MC_PITCH_TC"])

        def by_axis(suffix):
            return tuple(p[f"MC_{axis}RATE_{suffix}"] for axis in ("ROLL", "PITCH", "YAW"))

        def scaled(gains):
            return gains[0] * roll_scale, gains[1] * pitch_scale, gains[2]

        self.attitude_p = scaled((p["MC_ROLL_P"], p["MC_PITCH_P"], p["MC_YAW_P"]))
        self.rate_p = scaled(by_axis("P"))
        self.rate_i = by_axis("I")
        self.rate_d = scaled(by_axis("D"))
        self.rate_ff = by_axis("FF")
        self.rate_max = tuple(math.radians(rate) for rate in by_axis("MAX"))
        self.auto_rate_max = self.rate_max[:2] + (math.radians(p["MC_YAWRAUTO_MAX"]),)
        self.acro_rate_max = tuple(math.radians(p[f"MC_ACRO_{axis}_MAX"]) for axis in "RPY")
        self.yaw_ff = p["MC_YAW_FF"]
        self.weathervane_yaw_rate = self.auto_rate_max[2] * p["VT_WV_YAWR_SCL"]
        self.rattitude_threshold = p["MC_RATT_TH"]
        self.tpa_break = p.get("MC_TPA_BREAK", 1.0)
        self.tpa_slope = p.get("MC_TPA_SLOPE", 0.0)  # px4-v1.3.4 has no such attenuation
        self.scale_by_battery = p.get("MC_BAT_SCALE_EN", 0.0) != 0.0
        self.publish_actuators = p["CBRK_RATE_CTRL"] != 140253.0


def attitude_error(q, q_d):
    """The rotation vector from the attitude q to the setpoint q_d, in the body [rad], and the
    weight of yaw [1]. The shortest rotation of the thrust axis comes first, then yaw: so yaw, for
    which a multicopter has the least torque, does not delay the thrust."""
    r = rotation_matrix(q)
    r_sp = rotation_matrix(q_d)
    z_sp = column(r_sp, 2)
    z = column(r, 2)
    error = transposed_times(r, cross(z, z_sp))
    sin_tilt = math.sqrt(dot(error, error))
    cos_tilt = dot(z, z_sp)
    yaw_weight = r_sp[2][2] * r_sp[2][2]  # a product, because `**` raises on overflow
    if sin_tilt > 0.0:
        angle = math.atan2(sin_tilt, cos_tilt)
        axis = (error[0] / sin_tilt, error[1] / sin_tilt, error[2] / sin_tilt)
        error = (axis[0] * angle, axis[1] * angle)
        x_axis = _tilted_x_axis(axis, sin_tilt, cos_tilt)
        x = (dot(r[0], x_axis), dot(r[1], x_axis), dot(r[2], x_axis))
    else:
        x = column(r, 0)
    x_sp = column(r_sp, 0)
    yaw = math.atan2(dot(cross(x, x_sp), z_sp), dot(x, x_sp)) * yaw_weight
    error = (error[0], error[1], yaw)
    if cos_tilt < 0.0:
        error = _blended_with_direct(error, r, r_sp, cos_tilt * cos_tilt * yaw_weight)
    return error, yaw_weight


def _tilted_x_axis(axis, sin_tilt, cos_tilt):
    """The body x axis after the rotation about `axis`: the first column of Rodrigues' formula
    I + K sin + K^2 (1 - cos), with the cross-product matrix K of the axis."""
    x, y, z = axis
    versine = 1.0 - cos_tilt
    return (
        1.0 - (y * y + z * z) * versine,
        z * sin_tilt + x * y * versine,
        x * z * versine - y * sin_tilt,
    )


def _blended_with_direct(error, r, r_sp, direct_weight):
    """Beyond 90 degrees of tilt: blends with the shortest rotation to the setpoint, which has no
    singularity at half a turn. Near half a turn, the direction of `error` is arbitrary."""
    columns_sp = (column(r_sp, 0), column(r_sp, 1), column(r_sp, 2))
    difference = tuple(
        tuple(dot(column(r, i), column_sp) for column_sp in columns_sp) for i in range(3)
    )
    w, x, y, z = quaternion_of_matrix(difference)
    twice = 2.0 if w >= 0.0 else -2.0
    weight = 1.0 - direct_weight
    return (
        error[0] * weight + x * twice * direct_weight,
        error[1] * weight + y * twice * direct_weight,
        error[2] * weight + z * twice * direct_weight,
    )


def limited(rates, maxima):
    """Each rate within its own limit [rad/s]."""
    return (
        clamp(rates[0], -maxima[0], maxima[0]),
        clamp(rates[1], -maxima[1], maxima[1]),
        clamp(rates[2], -maxima[2], maxima[2]),
    )


def attitude_law(q, setpoint, gains, rate_max, weathervane, clamp_before_ff):
    """The rates setpoint [rad/s] for the attitude q and a setpoint with q_d and
    yaw_sp_move_rate. `weathervane`: the wind may turn the nose, so yaw is limited to a small rate.
    px4-v1.3.4 limits it before the feed-forward too (`clamp_before_ff`)."""
    error, yaw_weight = attitude_error(q, setpoint.q_d)
    p = gains.attitude_p
    roll, pitch, yaw = limited((p[0] * error[0], p[1] * error[1], p[2] * error[2]), rate_max)
    wind_max = gains.weathervane_yaw_rate
    if weathervane and clamp_before_ff:
        yaw = clamp(yaw, -wind_max, wind_max)
    yaw += setpoint.yaw_sp_move_rate * yaw_weight * gains.yaw_ff  # after the rate limit
    if weathervane:
        yaw = clamp(yaw, -wind_max, wind_max)
    return roll, pitch, yaw


def thrust_attenuation(thrust, gains):
    """The factor 0 .. 1 on the proportional gain. At high thrust, motors have more effect."""
    factor = 1.0 - gains.tpa_slope * (abs(thrust) - gains.tpa_break)
    if factor != factor:
        return 1.0  # as with fmin and fmax, which ignore a NaN
    return clamp(factor, 0.0, 1.0)


def rate_law(rates, rates_prev, rates_sp, feed_forward, attenuation, integrals, gains, dt):
    """The controls (roll, pitch, yaw) for rates [rad/s] of this step and of the previous one.
    The gains FF multiply `feed_forward`: the setpoint, or its rate of change."""
    p, d, ff = gains.rate_p, gains.rate_d, gains.rate_ff
    return tuple(
        p[i] * ((rates_sp[i] - rates[i]) * attenuation)
        + d[i] * (rates_prev[i] - rates[i]) / dt
        + integrals[i]
        + ff[i] * feed_forward[i]
        for i in (0, 1, 2)
    )


def integrate(integrals, controls, rates_error, thrust, yaw_is_saturated, gains, dt):
    """The integrals after a step of dt seconds. An axis keeps its integral while its control
    exceeds the thrust, while integral or control reach their limit, and, for yaw, while the mixer
    cuts yaw. The caller has excluded a vehicle on the ground and saturated motors."""
    result = list(integrals)
    for axis in (0, 1, 2):
        control = controls[axis]
        if not abs(control) < thrust or (axis == 2 and yaw_is_saturated):
            continue
        integral = integrals[axis] + gains.rate_i[axis] * rates_error[axis] * dt
        # The first comparison also refuses an integral that is not finite.
        if (
            -INTEGRAL_LIMIT < integral < INTEGRAL_LIMIT
            and -INTEGRAL_LIMIT < control < INTEGRAL_LIMIT
        ):
            result[axis] = integral
    return tuple(result)


def finite_or_zero(value):
    """The value of a control, or zero: an actuator must not receive NaN or infinity."""
    return value if is_finite(value) else 0.0
