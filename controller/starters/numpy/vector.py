# SPDX-License-Identifier: BSD-3-Clause
"""Vectors, matrices and quaternions in binary32, with the roundings of the firmware.

A vector is a float32 array of 3, a quaternion one of 4 {w, x, y, z}, a matrix one of 3 x 3.
Sums have the order of the firmware. `np.dot` and `@` leave the order to a BLAS library, and may
round a product and a sum once instead of twice: they are not used.

Before numpy 2, a Python number turns a float32 scalar into a float64. So constants are float32.
"""

import ctypes

import numpy as np

f32 = np.float32

ZERO, HALF, ONE, TWO = f32(0), f32(0.5), f32(1), f32(2)
PI = f32(3.14159265358979323846)
DEGREES_IN_HALF_TURN = f32(180)
IDENTITY = np.eye(3, dtype=f32)


def vector(*elements):
    return np.array(elements, dtype=f32)


def radians(degrees):
    return degrees / DEGREES_IN_HALF_TURN * PI


def clamp(value, low, high):
    """NaN passes, because both comparisons are false."""
    return np.where(value < low, low, np.where(value > high, high, value))


# The law's functions are rounded to the nearest float32. The double functions of the C library,
# rounded, give it for nearly every argument. Those of numpy depend on the processor.
_libm = ctypes.CDLL(None)  # the libraries that Python is linked with


def _from_libm(name, arguments):
    function = getattr(_libm, name)
    function.argtypes = [ctypes.c_double] * arguments
    function.restype = ctypes.c_double
    return lambda *values: f32(function(*values))


atan2 = _from_libm("atan2", 2)
acos = _from_libm("acos", 1)
exp = _from_libm("exp", 1)


# A sum that begins with 0 is never -0.
def dot(a, b):
    return ZERO + a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def norm(v):
    return np.sqrt(dot(v, v))


def cross(a, b):
    a0, a1, a2 = a
    b0, b1, b2 = b
    return vector(a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0)


def cross_matrix(v):
    """The matrix K for which K u = v x u."""
    x, y, z = v
    return np.array(((ZERO, -z, y), (z, ZERO, -x), (-y, x, ZERO)), dtype=f32)


def matrix_times_vector(m, v):
    return m[:, 0] * v[0] + m[:, 1] * v[1] + m[:, 2] * v[2]


def matrix_product(m, n):
    """Column k of `m` times row k of `n`, summed over k: each element is a sum in index order."""
    return ZERO + m[:, :1] * n[:1] + m[:, 1:2] * n[1:2] + m[:, 2:] * n[2:]


def rotation_matrix(q):
    """R(q), also of a quaternion that is not normalised."""
    a, b, c, d = q
    aa, bb, cc, dd = q * q
    return np.array(
        (
            (aa + bb - cc - dd, TWO * (b * c - a * d), TWO * (a * c + b * d)),
            (TWO * (b * c + a * d), aa - bb + cc - dd, TWO * (c * d - a * b)),
            (TWO * (b * d - a * c), TWO * (a * b + c * d), aa - bb - cc + dd),
        ),
        dtype=f32,
    )


def quaternion_of(m):
    """The quaternion of a rotation matrix. It divides by the largest component, or by w if the
    trace is positive, because a division by a small one is inaccurate."""
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    if trace > ZERO:
        s = np.sqrt(trace + ONE)
        w, s = s * HALF, HALF / s
        return vector(
            w, (m[2, 1] - m[1, 2]) * s, (m[0, 2] - m[2, 0]) * s, (m[1, 0] - m[0, 1]) * s
        )
    i = int(np.argmax(m.diagonal()))
    j, k = (i + 1) % 3, (i + 2) % 3
    s = np.sqrt(m[i, i] - m[j, j] - m[k, k] + ONE)
    q = np.empty(4, dtype=f32)
    q[1 + i], s = s * HALF, HALF / s
    q[1 + j] = (m[i, j] + m[j, i]) * s
    q[1 + k] = (m[k, i] + m[i, k]) * s
    q[0] = (m[k, j] - m[j, k]) * s
    return q


def conjugate(q):
    return vector(q[0], -q[1], -q[2], -q[3])


def quaternion_product(p, q):
    a, b, c, d = p
    w, x, y, z = q
    return vector(
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )
