# SPDX-License-Identifier: BSD-3-Clause
"""Attitude and its setpoint to a rates setpoint: the thrust axis first, then yaw.

A multicopter has the least torque about yaw, so yaw must not delay the thrust.
"""

from typing import NamedTuple, Tuple

from binary32 import ONE, TWO, ZERO, Binary32, acos, asin, cos, is_finite, sin
from parameters import AXES
from reference_model import ReferenceModel
from rotation import (
    IDENTITY,
    added,
    between,
    canonical,
    inverse,
    product,
    times,
    unit,
    z_axis,
)
from scalar import clamp, radians

OPPOSITE = Binary32(0.999989986)


class AttitudeSetpoint(NamedTuple):
    time_us: int  # when it was published
    q_d: Tuple[Binary32, ...]  # of any norm
    yaw_rate: Binary32  # [rad/s] about the world's z; ignored if not finite
    thrust_body: Tuple[Binary32, ...]  # along the body axes; negative z is up


class AttitudeLaw:
    def __init__(self):
        self.q_d = IDENTITY
        self.yaw_rate = ZERO

    def read(self, parameters):
        p = parameters
        self.yaw_weight = clamp(p["MC_YAW_WEIGHT"], ZERO, ONE)
        yaw_gain = p["MC_YAW_P"]
        if self.yaw_weight > Binary32(1e-4):
            yaw_gain = yaw_gain / self.yaw_weight  # so that the weight does not reduce the gain
        self.gains = (p["MC_ROLL_P"], p["MC_PITCH_P"], yaw_gain)
        self.limits = tuple(radians(p[f"MC_{axis}RATE_MAX"]) for axis in AXES)

    def follow(self, setpoint, elapsed):
        """Takes a setpoint, `elapsed` seconds after the previous one; None for the first one."""
        self.q_d = unit(setpoint.q_d)
        self.yaw_rate = setpoint.yaw_rate

    def turn(self, rotation):
        """The estimator turned the attitude: the setpoint turns with it."""
        self.q_d = unit(product(rotation, self.q_d))

    def rates(self, q):
        """The rates setpoint (roll, pitch, yaw) in the body [rad/s] for the attitude q."""
        error = canonical(product(inverse(q), self._weighted_setpoint(q)))
        rates = tuple(part * TWO * gain for part, gain in zip(error[1:], self.gains))
        rates = self._fed_forward(rates, q)
        return tuple(clamp(rate, -limit, limit) for rate, limit in zip(rates, self.limits))

    def _fed_forward(self, rates, q):
        if not is_finite(self.yaw_rate):
            return rates
        return added(rates, times(z_axis(inverse(q)), self.yaw_rate))

    def _weighted_setpoint(self, q):
        """The attitude with the thrust axis of q_d, and a part of the turn to its yaw."""
        tilted = between(z_axis(q), z_axis(self.q_d))
        if abs(tilted[1]) > OPPOSITE or abs(tilted[2]) > OPPOSITE:
            tilted = self.q_d  # the axis of a half turn is arbitrary
        else:
            tilted = product(tilted, q)
        turn = canonical(product(inverse(tilted), self.q_d))
        cosine = clamp(turn[0], -ONE, ONE)
        sine = clamp(turn[3], -ONE, ONE)
        weight = self.yaw_weight
        part = (cos(weight * acos(cosine)), ZERO, ZERO, sin(weight * asin(sine)))
        return product(tilted, part)


class AttitudeLawOfV118(AttitudeLaw):
    """q_d is the attitude of the reference model, which follows the setpoint."""

    def __init__(self):
        super().__init__()
        self.model = ReferenceModel()

    def read(self, parameters):
        super().read(parameters)
        self.model.read(parameters)

    def follow(self, setpoint, elapsed):
        target = unit(setpoint.q_d)
        if elapsed is None:
            self.q_d = target
            self.model.stop()
        else:
            self.q_d = self.model.moved(self.q_d, target, setpoint.yaw_rate, elapsed)

    def _fed_forward(self, rates, q):
        return self.model.fed_forward(rates, product(inverse(q), self.q_d))
