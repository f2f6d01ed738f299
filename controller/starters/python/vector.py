# SPDX-License-Identifier: BSD-3-Clause
"""Arithmetic with the results of IEEE 754 where Python raises, and vectors and quaternions.

A vector is a tuple (x, y, z), a matrix a tuple of three rows. A quaternion is Hamilton, scalar
first (w, x, y, z). Except for binary32(), every function returns NaN and infinity as C does, and
raises no exception.
"""

import math
import struct

_BINARY32 = struct.Struct("<f")


def binary32(value):
    """The binary32 number nearest to `value`. Inputs are binary32, and the firmware compares them
    with binary32 constants: an input of 0.2f must be equal to the constant 0.2, not above it."""
    return _BINARY32.unpack(_BINARY32.pack(value))[0]


LARGEST_BINARY32 = (2.0 - 2.0**-23) * 2.0**127


def is_finite(value):
    """Whether `value` is finite as a binary32. Binary64 holds larger numbers."""
    return -LARGEST_BINARY32 <= value <= LARGEST_BINARY32


def square_root(value):
    """NaN for a negative number, where math.sqrt raises."""
    return math.sqrt(value) if value >= 0.0 else math.nan


def divide(dividend, divisor):
    """Infinity or NaN for a divisor of zero, where `/` raises."""
    if divisor != 0.0:
        return dividend / divisor
    if dividend == 0.0 or dividend != dividend:
        return math.nan
    return math.copysign(math.inf, dividend) * math.copysign(1.0, divisor)


def clamp(value, low, high):
    """NaN passes, because both comparisons are false."""
    return low if value < low else (high if value > high else value)


def dot(a, b):
    """Starts at +0, so that a sum of zeros is +0. The sign selects the direction of a half turn:
    atan2(+0, -1) is pi, and atan2(-0, -1) is -pi."""
    return 0.0 + a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def column(matrix, index):
    return matrix[0][index], matrix[1][index], matrix[2][index]


def transposed_times(matrix, vector):
    """matrix^T vector. If the matrix rotates body to world, this rotates world to body."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    x, y, z = vector
    return a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z


def rotation_matrix(q):
    """R(q), body to world if q is. As in the law, q is not normalised first."""
    w, x, y, z = q
    ww, xx, yy, zz = w * w, x * x, y * y, z * z
    return (
        (ww + xx - yy - zz, 2.0 * (x * y - w * z), 2.0 * (w * y + x * z)),
        (2.0 * (x * y + w * z), ww - xx + yy - zz, 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (w * x + y * z), ww - xx - yy + zz),
    )


def conjugate(q):
    w, x, y, z = q
    return w, -x, -y, -z


def quaternion_product(p, q):
    pw, px, py, pz = p
    qw, qx, qy, qz = q
    return (
        pw * qw - px * qx - py * qy - pz * qz,
        pw * qx + px * qw + py * qz - pz * qy,
        pw * qy - px * qz + py * qw + pz * qx,
        pw * qz + px * qy - py * qx + pz * qw,
    )


def quaternion_of_matrix(d):
    """The quaternion of d. If d is far from a rotation, a root or a quotient may not be finite."""
    trace = d[0][0] + d[1][1] + d[2][2]
    if trace > 0.0:
        s = square_root(trace + 1.0)
        w = s * 0.5
        s = 0.5 / s
        return w, (d[2][1] - d[1][2]) * s, (d[0][2] - d[2][0]) * s, (d[1][0] - d[0][1]) * s
    i = 0  # the largest diagonal element, the first one if several are equal
    for candidate in (1, 2):
        if d[candidate][candidate] > d[i][i]:
            i = candidate
    j, k = (i + 1) % 3, (i + 2) % 3
    s = square_root((d[i][i] - d[j][j] - d[k][k]) + 1.0)
    q = [0.0, 0.0, 0.0, 0.0]
    q[1 + i] = s * 0.5
    s = divide(0.5, s)
    q[1 + j] = (d[i][j] + d[j][i]) * s
    q[1 + k] = (d[k][i] + d[i][k]) * s
    q[0] = (d[k][j] - d[j][k]) * s
    return tuple(q)
