# SPDX-License-Identifier: BSD-3-Clause
"""Limits, curves and filters of both units. The order of each sum is part of the law."""

from binary32 import EPSILON, ONE, PI, TWO_PI, ZERO, Binary32, floor

MOST_OF_A_STICK = Binary32(0.99)


def clamp(value, low, high):
    """NaN passes, because both comparisons are false."""
    return low if value < low else (high if value > high else value)


def smaller(a, b):
    """Returns b if a or b is NaN."""
    return a if a < b else b


def larger(a, b):
    """Returns b if a or b is NaN."""
    return a if a > b else b


def radians(degrees):
    return degrees * Binary32(0.0174532924)


def wrap(angle):
    """The angle within [-pi, pi) [rad]."""
    if -PI <= angle < PI:
        return angle
    turns = floor((angle + PI) * Binary32(0.159154937))
    return angle - TWO_PI * turns


def seconds(later_us, earlier_us):
    """The difference of two times [s]. Times are unsigned integers, as in the firmware."""
    return microseconds(later_us, earlier_us) * Binary32(1e-6)


def microseconds(later_us, earlier_us):
    return Binary32((later_us - earlier_us) % 2**64)


def line(value, x0, x1, y0, y1):
    """The straight line from (x0, y0) to (x1, y1), constant outside."""
    if value <= x0:
        return y0
    if value > x1:
        return y1
    gradient = (y1 - y0) / (x1 - x0)
    return gradient * value + (y0 - gradient * x0)


def expo(value, cubic_share):
    """A stick curve that is flat in the middle."""
    x = clamp(value, -ONE, ONE)
    c = clamp(cubic_share, ZERO, ONE)
    return (ONE - c) * x + c * x * x * x


def superexpo(value, cubic_share, gain):
    """A stick curve that is also steep at the ends."""
    x = clamp(value, -ONE, ONE)
    g = clamp(gain, ZERO, MOST_OF_A_STICK)
    return expo(x, cubic_share) * (ONE - g) / (ONE - abs(x) * g)


def dead_zone(value, zone):
    """Zero in the middle, and a line from there to the ends."""
    x = clamp(value, -ONE, ONE)
    z = clamp(zone, ZERO, MOST_OF_A_STICK)
    sign = ONE if x > ZERO else (-ONE if x < ZERO else ZERO)
    is_outside = ONE if abs(x) > z else ZERO
    return (x - sign * z) / (ONE - z) * is_outside


class LowPass:
    def __init__(self):
        self.state = ZERO
        self.weight = ZERO  # of a new value

    def update(self, tau, dt, value):
        """The filtered value. `tau` and `dt` in s."""
        self._set_weight(tau, dt)
        self.state = self.state + self.weight * (value - self.state)
        return self.state

    def _set_weight(self, tau, dt):
        if tau + dt > EPSILON:
            self.weight = dt / (tau + dt)


class LowPassOfV114(LowPass):
    """The same filter with other rounding."""

    def update(self, tau, dt, value):
        self._set_weight(tau, dt)
        self.state = (ONE - self.weight) * self.state + self.weight * value
        return self.state


def slewed(state, rate, dt, value):
    """The next state. It follows `value` by at most `rate` in each second."""
    step = rate * dt
    return state + clamp(value - state, -step, step)
