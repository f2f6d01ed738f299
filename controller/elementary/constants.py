#!/usr/bin/env python3
"""Prints constants.hpp: the constants of the elementary functions, derived exactly.

    constants.py > constants.hpp
    constants.py --check    exits 1 if constants.hpp differs from what this prints

pi is Machin's 16 atan(1/5) - 4 atan(1/239). ln 2 is 18 artanh(1/26) - 2 artanh(1/4801)
+ 8 artanh(1/8749). Each sum has at least 64 bits more than are printed. The polynomials are
interpolated at Chebyshev's nodes, in rational numbers.
"""

import math
import pathlib
import sys
from fractions import Fraction

FRACTION_LIMBS = 6  # of a Fixed, 192 bits
# Of 2/pi: 104 bits shift out for the largest float, whose last bit is 2^104. A significand of 24
# bits then leaves 224 of 352 correct bits, 32 more than a Fixed has.
TWO_OVER_PI_LIMBS = 11
BITS = 32 * TWO_OVER_PI_LIMBS + 64
ONE = 1 << BITS

HEADER = """\
// The constants of the elementary functions. Printed by constants.py, which derives them.
#pragma once

#include <cstdint>

// clang-format off
namespace attest::elementary {

// Of the exact path. Limbs of 32 bits, the least significant first; the last is the integer part.
// Bits beyond the fraction are cut off.
"""

TABLES = """
// Of the fast path, in double: a table, and coefficients of polynomials in x^2.
"""

FOOTER = """
}  // namespace attest::elementary
"""


def arc(p: int, q: int, sign: int) -> int:
    """atan(p/q) for sign -1, artanh(p/q) for 1, times 2^BITS: the sum of
    sign^n / (2n + 1) (p/q)^(2n + 1)."""
    power = ONE * p // q
    total, n = 0, 0
    while power:
        total += sign**n * (power // (2 * n + 1))
        power = power * p * p // (q * q)
        n += 1
    return total


PI = 16 * arc(1, 5, -1) - 4 * arc(1, 239, -1)
LN2 = 18 * arc(1, 26, 1) - 2 * arc(1, 4801, 1) + 8 * arc(1, 8749, 1)


def arc_tangent(i: int) -> int:
    return PI // 4 if i == 16 else arc(i, 16, -1)


def arc_sine(terms: int) -> list[Fraction]:
    """asin(x) / x as a series in x^2: (2n)! / (2^n n!)^2 / (2n + 1)."""
    share = Fraction(1)
    found = []
    for n in range(terms):
        found.append(share / (2 * n + 1))
        share *= Fraction(2 * n + 1, 2 * n + 2)
    return found


def alternating(terms: int, first: int) -> list[Fraction]:
    """cos(x) as a series in x^2 for first = 0, sin(x) / x for 1."""
    return [Fraction((-1) ** n, math.factorial(2 * n + first)) for n in range(terms)]


def value(series: list[Fraction], s: Fraction) -> Fraction:
    total = Fraction(0)
    for coefficient in reversed(series):
        total = total * s + coefficient
    return total


def fitted(series: list[Fraction], end: Fraction, terms: int) -> list[Fraction]:
    """The polynomial with this number of terms that equals the series at Chebyshev's nodes of
    0 .. end. Newton's divided differences. Its error must be below 2^-47, relative."""
    cosines = [math.cos((2 * k + 1) * math.pi / (2 * terms)) for k in range(terms)]
    # Rounded, so that they do not depend on the C library.
    nodes = [end * (1 + Fraction(round(1e6 * cosine), 1000000)) / 2 for cosine in cosines]
    differences = [value(series, node) for node in nodes]
    for level in range(1, terms):
        for k in range(terms - 1, level - 1, -1):
            step = nodes[k] - nodes[k - level]
            differences[k] = (differences[k] - differences[k - 1]) / step
    polynomial = [Fraction(0)] * terms
    for k in range(terms - 1, -1, -1):  # times (s - node), plus the difference
        polynomial = [
            (polynomial[n - 1] if n else 0) - nodes[k] * polynomial[n] for n in range(terms)
        ]
        polynomial[0] += differences[k]
    polynomial = [Fraction(float(coefficient)) for coefficient in polynomial]
    for k in range(257):
        exact = value(series, end * k / 256)
        assert abs(value(polynomial, end * k / 256) / exact - 1) < Fraction(1, 1 << 47)
    return polynomial


def array(kind: str, name: str, words: list[str], columns: int) -> str:
    rows = [", ".join(words[i : i + columns]) for i in range(0, len(words), columns)]
    start = f"inline constexpr {kind} {name}[{len(words)}] = {{\n    "
    return start + ",\n    ".join(rows) + "};\n"


def limbs(name: str, value: int, fraction: int) -> str:
    value >>= BITS - 32 * fraction
    words = [f"0x{value >> 32 * i & 0xFFFFFFFF:08x}" for i in range(fraction + 1)]
    return array("std::uint32_t", name, words, 8)


def doubles(name: str, values: list[Fraction]) -> str:
    return array("double", name, [float(value).hex() for value in values], 4)


def header() -> str:
    return (
        HEADER
        + limbs("two_over_pi", 2 * ONE * ONE // PI, TWO_OVER_PI_LIMBS)
        + limbs("half_pi", PI // 2, FRACTION_LIMBS)
        + limbs("ln2", LN2, FRACTION_LIMBS)
        + TABLES
        + "// atan(i/16)\n"
        + doubles("arc_tangents", [Fraction(arc_tangent(i), ONE) for i in range(17)])
        + "// sin(x) / x and cos(x) for x^2 up to 0.617, which is above (pi/4)^2\n"
        + doubles("sine_terms", fitted(alternating(20, 1), Fraction(617, 1000), 6))
        + doubles("cosine_terms", fitted(alternating(20, 0), Fraction(617, 1000), 7))
        + "// asin(x) / x for x^2 up to 1/4\n"
        + doubles("arc_sine_terms", fitted(arc_sine(40), Fraction(1, 4), 12))
        + FOOTER
    )


def main() -> int:
    if sys.argv[1:] == ["--check"]:
        kept = pathlib.Path(__file__).with_name("constants.hpp")
        if kept.read_text() == header():
            return 0
        print(f"{kept}: differs from what constants.py prints: print it again", file=sys.stderr)
        return 1
    print(header(), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
