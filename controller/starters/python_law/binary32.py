# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of IEEE 754 binary32, with which the firmware computes.

A float of Python is binary64. An operation of two numbers of binary32, computed in binary64 and
then rounded, has the result of the same operation in binary32: this holds for +, -, *, / and sqrt.
As in C, no operation raises an exception.
"""

import ctypes
import math


class Binary32(ctypes.c_float):
    """Both operands of an operator must be of this class: a float of Python, which is not rounded,
    has no `value` and is refused."""

    __slots__ = ()

    def __add__(self, other):
        return Binary32(self.value + other.value)

    def __sub__(self, other):
        return Binary32(self.value - other.value)

    def __mul__(self, other):
        return Binary32(self.value * other.value)

    def __truediv__(self, other):
        try:
            return Binary32(self.value / other.value)
        except ZeroDivisionError:  # where C gives infinity, or NaN for 0 / 0
            return Binary32(self.value * math.copysign(math.inf, other.value))

    def __neg__(self):
        return Binary32(-self.value)

    def __abs__(self):
        return Binary32(abs(self.value))

    def __eq__(self, other):
        return self.value == other.value

    def __lt__(self, other):
        return self.value < other.value

    def __le__(self, other):
        return self.value <= other.value

    def __gt__(self, other):
        return self.value > other.value

    __hash__ = None


ZERO = Binary32(0.0)
ONE = Binary32(1.0)
TWO = Binary32(2.0)
EPSILON = Binary32(2.0**-23)  # FLT_EPSILON


def is_finite(number):
    return math.isfinite(number.value)


def _of_libm(name):
    """A double function of the C library, which Python is linked with, rounded to binary32. This is
    the nearest number of binary32, also where the library's own float function is not."""
    function = getattr(ctypes.CDLL(None), name)
    function.argtypes = (ctypes.c_double,)
    function.restype = ctypes.c_double
    return lambda number: Binary32(function(number.value))


square_root = _of_libm("sqrt")
sin = _of_libm("sin")
cos = _of_libm("cos")
asin = _of_libm("asin")
acos = _of_libm("acos")
