# SPDX-License-Identifier: BSD-3-Clause
"""Vectors and quaternions as tuples of Binary32. The order of each sum is part of the law.

Quaternions are Hamilton, scalar first (w, x, y, z), and rotate the body (FRD) into the world (NED).
Their norm may be other than 1: only `unit` and `between` normalise.
"""

import math

from binary32 import (
    EPSILON,
    HALF,
    ONE,
    TWO,
    ZERO,
    Binary32,
    asin,
    atan2,
    cos,
    sin,
    square_root,
)

IDENTITY = (ONE, ZERO, ZERO, ZERO)
DOWN = (ZERO, ZERO, ONE)  # the z axis of the world
HALF_PI = Binary32(math.pi / 2.0)
NEARLY_VERTICAL = Binary32(0.001)  # [rad]


def dot(a, b):
    """Starts at +0, so that a sum of zeros is +0."""
    total = ZERO
    for x, y in zip(a, b):
        total = total + x * y
    return total


def norm(v):
    return square_root(dot(v, v))


def times(v, factor):
    return tuple(x * factor for x in v)


def unit(v):
    """A vector of norm 1; NaN for a zero."""
    return times(v, ONE / norm(v))


def added(a, b):
    return tuple(x + y for x, y in zip(a, b))


def subtracted(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    (a0, a1, a2), (b0, b1, b2) = a, b
    return a1 * b2 - a2 * b1, -a0 * b2 + a2 * b0, a0 * b1 - a1 * b0


def product(q, p):
    q0, q1, q2, q3 = q
    p0, p1, p2, p3 = p
    return (
        q0 * p0 - q1 * p1 - q2 * p2 - q3 * p3,
        q1 * p0 + q0 * p1 - q3 * p2 + q2 * p3,
        q2 * p0 + q3 * p1 + q0 * p2 - q1 * p3,
        q3 * p0 - q2 * p1 + q1 * p2 + q0 * p3,
    )


def inverse(q):
    n = dot(q, q)
    return q[0] / n, -q[1] / n, -q[2] / n, -q[3] / n


def turned(q, v):
    """The vector v, turned by q."""
    return product(product(q, (ZERO, *v)), inverse(q))[1:]


def canonical(q):
    """q or -q: the one whose first component that is not almost 0 is positive."""
    for component in q:
        if abs(component) > EPSILON:
            return q if component > ZERO else tuple(-x for x in q)
    return q


def z_axis(q):
    """The body's z axis in the world."""
    q0, q1, q2, q3 = q
    return (
        TWO * (q0 * q2 + q1 * q3),
        TWO * (q2 * q3 - q0 * q1),
        q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3,
    )


def between(a, b):
    """The shortest rotation that turns vector a into vector b."""
    axis = cross(a, b)
    cosine = dot(a, b)
    if norm(axis) < Binary32(1e-5) and cosine < ZERO:
        return unit((ZERO, *cross(a, _axis_away_from(a))))
    return unit((cosine + square_root(dot(a, a) * dot(b, b)), *axis))


def _axis_away_from(v):
    """The coordinate axis along which the magnitude of v is smallest."""
    x, y, z = (abs(component) for component in v)
    if x < y:
        return (ONE, ZERO, ZERO) if x < z else (ZERO, ZERO, ONE)
    return (ZERO, ONE, ZERO) if y < z else (ZERO, ZERO, ONE)


def of_rotation_vector(v):
    """The rotation about v by the length of v [rad]."""
    angle = norm(v)
    if angle < Binary32(1e-10):
        return IDENTITY
    axis = times(v, ONE / angle)
    return (cos(angle * HALF), *times(axis, sin(angle * HALF)))


def of_heading(heading):
    return cos(heading * HALF), ZERO, ZERO, sin(heading * HALF)


def heading_of(q):
    """Yaw of the Euler angles [rad]."""
    return _heading(q, ONE - TWO * (q[2] * q[2] + q[3] * q[3]))


def heading_of_in_v114(q):
    """The same with other rounding. If the norm of q is not 1, the value differs."""
    q0, q1, q2, q3 = q
    return _heading(q, q0 * q0 + q1 * q1 - q2 * q2 - q3 * q3)


def _heading(q, r00):
    """`r..` are elements of the rotation matrix of q."""
    q0, q1, q2, q3 = q
    pitch = asin(-(TWO * (q1 * q3 - q0 * q2)))
    r12 = TWO * (q2 * q3 - q0 * q1)
    r02 = TWO * (q0 * q2 + q1 * q3)
    if abs(pitch - HALF_PI) < NEARLY_VERTICAL:
        return atan2(r12, r02)
    if abs(pitch + HALF_PI) < NEARLY_VERTICAL:
        return atan2(-r12, -r02)
    return atan2(TWO * (q1 * q2 + q0 * q3), r00)
