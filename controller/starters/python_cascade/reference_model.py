# SPDX-License-Identifier: BSD-3-Clause
"""The reference model of v1.18: the attitude that the law follows does not jump.

A critically damped model of second order moves this reference towards each setpoint, by the time
since the previous one. Between setpoints the reference stands still.
"""

from binary32 import EPSILON, ONE, TWO, ZERO, Binary32, exp, is_finite
from rotation import (
    added,
    canonical,
    dot,
    inverse,
    of_rotation_vector,
    product,
    subtracted,
    times,
    turned,
    unit,
    z_axis,
)
from scalar import clamp, larger, radians

LEAST_FREQUENCY = Binary32(0.1)  # [rad/s]
AT_REST = (ZERO, ZERO, ZERO)


class ReferenceModel:
    """The rates of the reference [rad/s], in its frame before its last move. AttitudeLaw has the
    attitude of the reference."""

    def __init__(self):
        self.stop()

    def stop(self):
        self.rates = AT_REST  # of the model
        self.commanded = AT_REST  # the yaw rate of the setpoint, about the world's z

    def read(self, parameters):
        p = parameters
        self.frequency = larger(p["MC_REF_W_N"], LEAST_FREQUENCY)
        self.share = clamp(p["MC_REF_FF"], ZERO, ONE)
        self.limit = larger(radians(p["MC_REF_FF_MAX"]), ZERO)  # zero: no limit

    def moved(self, reference, target, yaw_rate, dt):
        """The attitude of the reference after `dt` [s]."""
        to_reference = inverse(reference)
        world_z = z_axis(to_reference)
        self.commanded = times(world_z, yaw_rate) if is_finite(yaw_rate) else AT_REST
        # Twice the sine of half the angle: a large step ends short of the target.
        error = times(canonical(product(to_reference, target))[1:], TWO)
        turn = added(self._decay(error, dt), times(self.commanded, dt))
        if is_finite(yaw_rate) and abs(yaw_rate) > EPSILON:
            # The commanded rate is the whole rate about this axis.
            self.rates = subtracted(self.rates, times(world_z, dot(self.rates, world_z)))
        return unit(product(reference, of_rotation_vector(turn)))

    def _decay(self, error, dt):
        """How far the reference turns in `dt` [rad], without the command. Updates the rates."""
        w = self.frequency
        k = w * dt
        decay = exp(-k)
        of_error, of_rates = ONE - (ONE + k) * decay, dt * decay
        turn = added(times(error, of_error), times(self.rates, of_rates))
        gained, kept = w * w * dt * decay, (ONE - k) * decay
        self.rates = added(times(error, gained), times(self.rates, kept))
        return turn

    def fed_forward(self, rates, to_body):
        """`rates` with those of the reference, which `to_body` turns into the body frame."""
        fed = times(turned(to_body, self.rates), self.share)
        if self.limit > ZERO:
            fed = tuple(clamp(rate, -self.limit, self.limit) for rate in fed)
        return added(added(rates, turned(to_body, self.commanded)), fed)
