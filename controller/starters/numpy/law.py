# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the law: attitude error, rates setpoint, throttle attenuation, integrals.

They have no state. World is NED, body is FRD, a quaternion {w, x, y, z} rotates body into world.
The law is that of `mc_att_control` at the tags v1.5.5 and v1.3.4 of PX4.
"""

import numpy as np

from vector import (
    IDENTITY,
    ONE,
    TWO,
    ZERO,
    atan2,
    clamp,
    cross,
    cross_matrix,
    dot,
    f32,
    matrix_product,
    matrix_times_vector,
    norm,
    quaternion_of,
    radians,
    rotation_matrix,
    vector,
)

# Names and defaults of the firmware. Rates with _MAX are in deg/s.
DEFAULTS = {
    "MC_ROLL_TC": 0.2,
    "MC_PITCH_TC": 0.2,
    "MC_ROLL_P": 6.5,
    "MC_PITCH_P": 6.5,
    "MC_YAW_P": 2.8,
    "MC_ROLLRATE_P": 0.15,
    "MC_ROLLRATE_I": 0.05,
    "MC_ROLLRATE_D": 0.003,
    "MC_ROLLRATE_FF": 0,
    "MC_PITCHRATE_P": 0.15,
    "MC_PITCHRATE_I": 0.05,
    "MC_PITCHRATE_D": 0.003,
    "MC_PITCHRATE_FF": 0,
    "MC_YAWRATE_P": 0.2,
    "MC_YAWRATE_I": 0.1,
    "MC_YAWRATE_D": 0,
    "MC_YAWRATE_FF": 0,
    "MC_YAW_FF": 0.5,
    "MC_ROLLRATE_MAX": 220,
    "MC_PITCHRATE_MAX": 220,
    "MC_YAWRATE_MAX": 200,
    "MC_YAWRAUTO_MAX": 45,
    "MC_ACRO_R_MAX": 360,
    "MC_ACRO_P_MAX": 360,
    "MC_ACRO_Y_MAX": 360,
    "MC_RATT_TH": 1,
    "MC_TPA_BREAK": 1,
    "MC_TPA_SLOPE": 1,
    "MC_BAT_SCALE_EN": 0,
    "VT_WV_YAWR_SCL": 0.15,
    "VT_TYPE": 0,
    "VT_OPT_RECOV_EN": 0,
    "CBRK_RATE_CTRL": 0,
}

DEFAULT_TIME_CONSTANT = f32(0.2)
THRUST_MIN_FOR_INTEGRAL = f32(0.2)
INTEGRAL_MAX = f32(0.3)  # of an integral, and of a control whose integral moves


class Gains:
    """Gains and limits, computed from `parameters`, a dict of float32 scalars."""

    def __init__(self, parameters):
        def of_axes(*names):
            return vector(*(parameters[name] for name in names))

        def of_rates(suffix):
            return of_axes(*(f"MC_{axis}RATE_{suffix}" for axis in ("ROLL", "PITCH", "YAW")))

        time_constants = of_axes("MC_ROLL_TC", "MC_PITCH_TC")
        of_time_constants = np.append(DEFAULT_TIME_CONSTANT / time_constants, ONE)
        self.attitude_p = of_axes("MC_ROLL_P", "MC_PITCH_P", "MC_YAW_P") * of_time_constants
        self.rate_p = of_rates("P") * of_time_constants
        self.rate_i = of_rates("I")
        self.rate_d = of_rates("D") * of_time_constants
        self.rate_ff = of_rates("FF")
        self.yaw_ff = parameters["MC_YAW_FF"]
        self.rate_max = radians(of_rates("MAX"))
        self.auto_rate_max = radians(
            of_axes("MC_ROLLRATE_MAX", "MC_PITCHRATE_MAX", "MC_YAWRAUTO_MAX")
        )
        self.weather_vane_rate_max = self.auto_rate_max[2] * parameters["VT_WV_YAWR_SCL"]
        self.acro_rate_max = radians(of_axes("MC_ACRO_R_MAX", "MC_ACRO_P_MAX", "MC_ACRO_Y_MAX"))
        self.rattitude_threshold = parameters["MC_RATT_TH"]
        self.tpa_break = parameters["MC_TPA_BREAK"]
        self.tpa_slope = parameters["MC_TPA_SLOPE"]
        self.scales_with_battery = parameters["MC_BAT_SCALE_EN"] != ZERO
        self.breaks_circuit = parameters["CBRK_RATE_CTRL"] == f32(140253)


def attitude_error(q, q_d):
    """The rotation from `q` to `q_d` as a vector [rad] about the body axes, and the weight of yaw,
    which decreases with the tilt of the setpoint. Tilt is corrected first: the yaw error is that
    which remains after the shortest rotation of the thrust axis."""
    r = rotation_matrix(q)
    r_sp = rotation_matrix(q_d)
    z, z_sp = r[:, 2], r_sp[:, 2]
    error = matrix_times_vector(r.T, cross(z, z_sp))
    sin_tilt, cos_tilt = norm(error), dot(z, z_sp)
    yaw_weight = r_sp[2, 2] * r_sp[2, 2]
    r_tilted = r  # attitude after the tilt error is corrected
    if sin_tilt > ZERO:
        axis = error / sin_tilt
        error = axis * atan2(sin_tilt, cos_tilt)
        k = cross_matrix(axis)
        rodrigues = (IDENTITY + k * sin_tilt) + matrix_product(k, k) * (ONE - cos_tilt)
        r_tilted = matrix_product(r, rodrigues)
    x_sp, x = r_sp[:, 0], r_tilted[:, 0]
    error[2] = atan2(dot(cross(x, x_sp), z_sp), dot(x, x_sp)) * yaw_weight
    if cos_tilt < ZERO:  # beyond 90 deg: blend with the direct rotation
        q_error = quaternion_of(matrix_product(r.T, r_sp))
        direct = (q_error[1:] if q_error[0] >= ZERO else -q_error[1:]) * TWO
        direct_weight = cos_tilt * cos_tilt * yaw_weight
        error = error * (ONE - direct_weight) + direct * direct_weight
    return error, yaw_weight


def limited_rates(error, yaw_weight, setpoint, mode, gains, is_v134):
    """Rates setpoint [rad/s] for an attitude error, and whether the weather-vane is on: the wind
    may then turn the nose, and the yaw rate has a smaller limit."""
    is_auto = mode["flag_control_velocity_enabled"]
    if not is_v134:
        is_auto = is_auto or mode["flag_control_auto_enabled"]
    if mode["flag_control_manual_enabled"]:
        is_auto = False
    is_weather_vane = is_auto and setpoint["disable_mc_yaw_control"]
    limit = gains.auto_rate_max if is_auto else gains.rate_max
    yaw_limit = gains.weather_vane_rate_max
    rates = clamp(gains.attitude_p * error, -limit, limit)
    if is_weather_vane and is_v134:
        rates[2] = clamp(rates[2], -yaw_limit, yaw_limit)
    rates[2] += setpoint["yaw_sp_move_rate"] * yaw_weight * gains.yaw_ff
    if is_weather_vane:
        rates[2] = clamp(rates[2], -yaw_limit, yaw_limit)
    return rates, is_weather_vane


def throttle_attenuation(thrust, gains):
    """Factor on P that decreases at high thrust; 1 if `thrust` is NaN."""
    excess = abs(thrust) - gains.tpa_break
    return np.fmax(ZERO, np.fmin(ONE, ONE - gains.tpa_slope * excess))


def new_integrals(integrals, controls, error, dt, thrust, limits, gains, is_v134):
    """The integrals after this step. All stay at low thrust or at a motor limit. One axis
    stays if its control or its new integral is at a limit."""
    # `not thrust > ...` is also true for a thrust of NaN.
    if not thrust > THRUST_MIN_FOR_INTEGRAL or limits["lower_limit"] or limits["upper_limit"]:
        return integrals
    moved = integrals + gains.rate_i * error * dt
    may_move = (
        (abs(controls) < thrust)
        & (abs(moved) < INTEGRAL_MAX)  # false for NaN
        & (abs(controls) < INTEGRAL_MAX)
    )
    if limits["yaw"] and not is_v134:
        may_move[2] = False
    return np.where(may_move, moved, integrals)
