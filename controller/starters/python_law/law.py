# SPDX-License-Identifier: BSD-3-Clause
"""The attitude law of PX4 v1.14 to v1.17, and the rate law of v1.14 to v1.18.

World is NED, body is FRD. Quaternions are (w, x, y, z), body to world. Vectors are about body
x, y, z: roll, pitch, yaw. All numbers are Binary32. The order of each sum and product is part of
the law: another order changes the last bits.
"""

from binary32 import EPSILON, ONE, TWO, ZERO, Binary32, acos, asin, cos, is_finite, sin, square_root


def attitude_law(q, q_d, yaw_rate, p, rate_max, yaw_weight):
    """The rates setpoint [rad/s] from an attitude and its setpoint, which may have any norm.

    `yaw_rate` [rad/s] is about the world's z, and is added to the result. It is ignored if it is
    not finite. `p` is in 1/s, `rate_max` in rad/s. `yaw_weight` (0 .. 1) says how much yaw counts
    compared with roll and pitch.
    """
    q_d = unit(q_d)
    weight = clamp(yaw_weight, ZERO, ONE)
    # Tilt first, then as much of the yaw error as the weight says.
    reduced = tilted(q, q_d)
    mix_w, _, _, mix_z = canonical(product(inverse(reduced), q_d))
    half_angle = weight * acos(clamp(mix_w, -ONE, ONE))
    half_angle_z = weight * asin(clamp(mix_z, -ONE, ONE))
    yaw = (cos(half_angle), ZERO, ZERO, sin(half_angle_z))
    _, *error = canonical(product(inverse(q), product(reduced, yaw)))
    # The weight made the yaw error smaller. This gain makes up for it.
    yaw_p = p[2] / weight if weight > Binary32(1e-4) else p[2]
    rates = [e * TWO * gain for e, gain in zip(error, (p[0], p[1], yaw_p))]
    if is_finite(yaw_rate):
        world_z = z_axis(inverse(q))  # in the body frame
        rates = [rate + z * yaw_rate for rate, z in zip(rates, world_z)]
    return [clamp(rate, -most, most) for rate, most in zip(rates, rate_max)]


class RateLaw:
    """The torque from the rates [rad/s]. Its state is the integral of each axis."""

    NO_INTEGRAL_ERROR = Binary32(6.98131704)  # [rad/s] 400 deg/s: too large to integrate

    def __init__(self):
        self.reset()

    def reset(self):
        self.integral = [ZERO] * 3

    def torque(self, gains, rates, derivative, rates_sp, positive, negative, landed, dt):
        """`gains` has `p`, `i`, `d`, `ff` and `integral_max`. `positive` and `negative` are flags:
        the motors cannot give more torque about that axis in that direction. `derivative` is that
        of the rates [rad/s^2], `dt` is in s."""
        error = [sp - rate for sp, rate in zip(rates_sp, rates)]
        torque = [
            gains["p"][axis] * error[axis]
            + self.integral[axis]
            - gains["d"][axis] * derivative[axis]
            + gains["ff"][axis] * rates_sp[axis]
            for axis in range(3)
        ]
        for axis in range(3) if not landed else ():
            self._integrate(axis, gains, error[axis], positive[axis], negative[axis], dt)
        return torque

    def _integrate(self, axis, gains, error, positive, negative, dt):
        # No integral against a saturated motor. A NaN becomes 0 here.
        if positive:
            error = error if error < ZERO else ZERO
        if negative:
            error = error if error > ZERO else ZERO
        ratio = error / self.NO_INTEGRAL_ERROR
        left = ONE - ratio * ratio
        share = ZERO if ZERO > left else left  # the larger the error, the less integral
        total = self.integral[axis] + share * gains["i"][axis] * error * dt
        if is_finite(total):
            most = gains["integral_max"][axis]
            self.integral[axis] = clamp(total, -most, most)


def tilted(q, q_d):
    """The attitude that has the thrust direction of q_d, and the heading of q as far as it can."""
    opposite = Binary32(0.999989986)
    tilt = between(z_axis(q), z_axis(q_d))
    if abs(tilt[1]) > opposite or abs(tilt[2]) > opposite:
        return q_d
    return product(tilt, q)


def between(a, b):
    """The shortest rotation that turns a into b. If they are opposite, half a turn about an
    axis."""
    axis = cross(a, b)
    w = dot(a, b)
    if square_root(dot(axis, axis)) < Binary32(1e-5) and w < ZERO:
        axis = cross(a, most_perpendicular_axis(a))
        w = ZERO
    else:
        w = w + square_root(dot(a, a) * dot(b, b))
    return unit((w, *axis))


def most_perpendicular_axis(v):
    x, y, z = (abs(component) for component in v)
    if x < y and x < z:
        return (ONE, ZERO, ZERO)
    if not x < y and y < z:
        return (ZERO, ONE, ZERO)
    return (ZERO, ZERO, ONE)


def z_axis(q):
    """The z axis of the rotated frame: of body to world, the direction opposite to thrust."""
    w, x, y, z = q
    return (TWO * (w * y + x * z), TWO * (y * z - w * x), w * w - x * x - y * y + z * z)


def canonical(q):
    """Of the two quaternions of a rotation, the one whose first component other than 0 is
    positive."""
    for component in q:
        if abs(component) > EPSILON:
            sign = ONE if component > ZERO else -ONE
            return tuple(c * sign for c in q)
    return q


def unit(q):
    reciprocal = ONE / square_root(dot(q, q))
    return tuple(c * reciprocal for c in q)


def inverse(q):
    n = dot(q, q)
    w, x, y, z = q
    return (w / n, -x / n, -y / n, -z / n)


def product(q, p):
    a, b, c, d = q
    w, x, y, z = p
    return (
        a * w - b * x - c * y - d * z,
        b * w + a * x - d * y + c * z,
        c * w + d * x + a * y - b * z,
        d * w - c * x + b * y + a * z,
    )


def dot(a, b):
    total = ZERO
    for i, j in zip(a, b):
        total = total + i * j
    return total


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], -a[0] * b[2] + a[2] * b[0], a[0] * b[1] - a[1] * b[0])


def clamp(value, low, high):
    """Passes NaN."""
    return low if value < low else high if value > high else value
