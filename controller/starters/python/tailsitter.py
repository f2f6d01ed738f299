# SPDX-License-Identifier: BSD-3-Clause
"""The outer loop of a tailsitter with VT_OPT_RECOV_EN: PX4 v1.5.5 TailsitterRecovery.

From a large tilt the vehicle returns on the path of least time. The functions are fitted to
solutions of an optimisation, with the constants below. A port for multicopters only can leave this
file out.
"""

import math

from law import limited
from vector import (
    clamp,
    conjugate,
    cross,
    dot,
    quaternion_product,
    rotation_matrix,
    transposed_times,
)

RECOVERY_STARTS_RAD = math.radians(30.0)
RECOVERY_ENDS_RAD = math.radians(5.0)
HALF_PI = math.pi / 2.0
THRUST_AXIS = (0.0, 0.0, -1.0)  # along -z of the body


class TailsitterRecovery:
    """Its state is whether a recovery is in progress."""

    def __init__(self):
        self.is_recovering = False

    def rates_setpoint(self, q, setpoint, gains):
        """The rates setpoint in the body [rad/s] for the attitude q, body to world."""
        tilt, direction = tilt_error(q, setpoint.q_d)
        if abs(tilt) > RECOVERY_STARTS_RAD:
            self.is_recovering = True
        elif abs(tilt) < RECOVERY_ENDS_RAD:
            self.is_recovering = False
        if self.is_recovering:
            roll, pitch, yaw = recovery_rates(tilt, direction)
        else:
            roll, pitch, yaw = quaternion_law(q, setpoint.q_d, gains)
        uprightness = clamp(rotation_matrix(q)[2][2], 0.0, 1.0)
        yaw += setpoint.yaw_sp_move_rate * uprightness * gains.yaw_ff
        return limited((roll, pitch, yaw), gains.rate_max)


def tilt_error(q, q_d):
    """The angle between the thrust axes [rad], and the azimuth of the tilt axis [rad]."""
    r_error = rotation_matrix(quaternion_product(q, conjugate(q_d)))
    rotated = (-r_error[0][2], -r_error[1][2], -r_error[2][2])
    cos_tilt = dot(rotated, THRUST_AXIS)
    if cos_tilt >= 1.0:
        tilt = 0.0  # a cosine that is rounded above 1 would make math.acos raise
    elif cos_tilt <= -1.0:
        tilt = math.pi
    else:
        tilt = math.acos(cos_tilt)
    axis = THRUST_AXIS  # at no tilt and at half a turn the axis is arbitrary
    if min(abs(tilt), abs(tilt - math.pi)) > 1e-5:
        axis = cross(rotated, THRUST_AXIS)
    axis = transposed_times(rotation_matrix(q), axis)
    return tilt, math.atan2(axis[0], axis[1])


def _first_quadrant(direction):
    """The azimuth folded into 0 .. pi/2, and the signs of the rates that undo the folding."""
    if direction < -HALF_PI:
        return direction + math.pi, (-1.0, -1.0, 1.0)
    if direction < 0.0:
        return -direction, (-1.0, 1.0, -1.0)
    if direction < HALF_PI:
        return direction, (1.0, 1.0, 1.0)
    return math.pi - direction, (1.0, -1.0, -1.0)


def _sigmoid(value):
    return 1.0 / (1.0 + math.exp(-value))


def recovery_rates(tilt, direction):
    """The rates of the path of least time, in the body [rad/s]."""
    direction, signs = _first_quadrant(direction)
    x, y = tilt, HALF_PI - direction
    pitch = (1.38 * y + 0.8725 * y * y) * (
        -1.676 * x * _sigmoid(2.642 * (0.3586 - x))
        + 1.676 * x * math.exp(2.642 * (0.3586 - math.pi)) * _sigmoid(2.642 * (math.pi - 0.3586))
    )
    azimuth_share = y / HALF_PI * (y / HALF_PI)
    roll = -3.997 * x + azimuth_share * (3.997 * x * _sigmoid(4.013 * (2.133 - x)))
    yaw = (3.168 * y - 0.3913 * y * y) * (
        2.726 * (x - math.pi) * _sigmoid(2.298 * (x - 1.75))
        - 2.726 * (x - math.pi) * _sigmoid(-1.75 * 2.298)
    )
    return roll * -signs[0], pitch * -signs[1] * 1.5, yaw * -signs[2]


def quaternion_law(q, q_d, gains):
    """Without a recovery: the rates [rad/s] are proportional to the error quaternion."""
    w, x, y, z = quaternion_product(conjugate(q_d), q)
    twice = -2.0 if w > 0.0 else 2.0
    p = gains.attitude_p
    return p[0] * x * twice, p[1] * y * twice, clamp(p[2] * z * twice, -1.0, 1.0)
