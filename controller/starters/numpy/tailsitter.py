# SPDX-License-Identifier: BSD-3-Clause
"""Recovery of a tailsitter from a large tilt: fitted rates for each tilt and tilt direction.

It replaces the attitude law if VT_TYPE is 0 and VT_OPT_RECOV_EN is not 0 at the first step.
The law and its fitted constants are those of `TailsitterRecovery` at the tag v1.5.5 of PX4.
"""

import numpy as np

from vector import (
    HALF,
    ONE,
    PI,
    TWO,
    ZERO,
    acos,
    atan2,
    clamp,
    conjugate,
    cross,
    dot,
    exp,
    f32,
    matrix_times_vector,
    quaternion_product,
    radians,
    rotation_matrix,
    vector,
)

RIGHT_ANGLE = PI * HALF
UP = vector(0, 0, -1)
TILT_ON = radians(f32(30))
TILT_OFF = radians(f32(5))
TILT_WITH_AXIS = f32(1e-5)


def sigmoid(v):
    return ONE / (ONE + exp(-v))


def tilt_and_direction(q, q_sp):
    """Angle [rad] between the thrust axes, and the direction [rad] of the tilt in the body."""
    up_error = matrix_times_vector(
        rotation_matrix(quaternion_product(q, conjugate(q_sp))), UP
    )
    cos_tilt = dot(up_error, UP)
    if cos_tilt >= ONE:
        tilt = ZERO
    elif cos_tilt <= -ONE:
        tilt = PI
    else:
        tilt = acos(cos_tilt)
    axis = UP
    if min(abs(tilt), abs(tilt - PI)) > TILT_WITH_AXIS:
        axis = cross(up_error, UP)
    axis = matrix_times_vector(rotation_matrix(q).T, axis)
    return tilt, atan2(axis[0], axis[1])


def folded(direction):
    """The direction folded into 0 .. pi/2, and the signs of the rates that undo the folding."""
    if direction < -RIGHT_ANGLE:
        return direction + PI, vector(-1, -1, 1)
    if direction < ZERO:
        return -direction, vector(-1, 1, -1)
    if direction < RIGHT_ANGLE:
        return direction, vector(1, 1, 1)
    return PI - direction, vector(1, -1, -1)


def fitted_rates(tilt, direction):
    direction, signs = folded(direction)
    x, y = tilt, RIGHT_ANGLE - direction
    part = y / RIGHT_ANGLE
    a, b = f32(1.676), f32(2.642)
    roll = f32(-3.997) * x + part * part * (
        f32(3.997) * x * sigmoid(f32(4.013) * (f32(2.133) - x))
    )
    pitch = (f32(1.38) * y + f32(0.8725) * (y * y)) * (
        -a * x * sigmoid(b * (f32(0.3586) - x))
        + a * x * exp(b * (f32(0.3586) - PI)) * sigmoid(b * (PI - f32(0.3586)))
    )
    yaw = (f32(3.168) * y - f32(0.3913) * (y * y)) * (
        f32(2.726) * (x - PI) * sigmoid(f32(2.298) * (x - f32(1.75)))
        - f32(2.726) * (x - PI) * sigmoid(f32(-1.75) * f32(2.298))
    )
    return vector(roll, pitch, yaw) * -signs * vector(1, 1.5, 1)


class Recovery:
    """A recovery begins beyond 30 deg of tilt error and ends below 5 deg. Its flag is the only
    state."""

    def __init__(self):
        self.is_on = False

    def rates(self, q, setpoint, gains):
        """Rates setpoint [rad/s]."""
        q_sp = setpoint["q_d"]
        tilt, direction = tilt_and_direction(q, q_sp)
        if abs(tilt) > TILT_ON:
            self.is_on = True
        elif abs(tilt) < TILT_OFF:
            self.is_on = False
        if self.is_on:
            rates = fitted_rates(tilt, direction)
        else:
            q_error = quaternion_product(conjugate(q_sp), q)
            rates = gains.attitude_p * q_error[1:] * (-TWO if q_error[0] > ZERO else TWO)
            rates[2] = clamp(rates[2], -ONE, ONE)
        yaw_weight = clamp(max(rotation_matrix(q)[2, 2], ZERO), ZERO, ONE)
        rates[2] += setpoint["yaw_sp_move_rate"] * yaw_weight * gains.yaw_ff
        return clamp(rates, -gains.rate_max, gains.rate_max)
