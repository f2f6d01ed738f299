/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * attest_math.h - the elementary functions of the law, correctly rounded.
 *
 * Each function returns the float nearest to the exact value (ties to even, subnormal results
 * included). For zeros, infinities and NaN it returns what Annex F of C requires. Every NaN that a
 * function returns has the bits 0x7fc00000. So a result has the same bits on every machine. It does
 * not depend on the C library, fused multiply-adds, the rounding mode, or whether the processor
 * flushes subnormal numbers to zero.
 *
 * Angles are in rad. The functions do not set errno, and the floating-point exception flags are
 * unspecified. Pure functions; any thread. Compiles as C11 and as C++17.
 *
 * REQUIRES: float is binary32, double is binary64, and sqrt() of a double is that of IEEE 754.
 */
#ifndef ATTEST_MATH_H
#define ATTEST_MATH_H

#ifdef __cplusplus
extern "C" {
#endif

float attest_sinf(float x);
float attest_cosf(float x);
float attest_tanf(float x);
float attest_asinf(float x);
float attest_acosf(float x);
float attest_expf(float x);
float attest_atan2f(float y, float x);

#ifdef __cplusplus
}
#endif

#endif /* ATTEST_MATH_H */
