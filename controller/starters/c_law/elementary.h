/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * elementary.h - the elementary functions of the law, rounded to the nearest float.
 *
 * The float functions of many C libraries are often off by the last bit, so a port that calls them
 * does not conform at the level exact. The double functions, rounded to float, give the nearest
 * float for nearly every argument. For every argument define
 * ATTEST_MATH, and link the functions of attest_math.h.
 */
#ifndef ATTEST_STARTER_ELEMENTARY_H
#define ATTEST_STARTER_ELEMENTARY_H

#ifdef ATTEST_MATH
#include <attest_math.h>
static inline float law_sin(float x) { return attest_sinf(x); }
static inline float law_cos(float x) { return attest_cosf(x); }
static inline float law_asin(float x) { return attest_asinf(x); }
static inline float law_acos(float x) { return attest_acosf(x); }
#else
#include <math.h>
static inline float law_sin(float x) { return (float)sin((double)x); }
static inline float law_cos(float x) { return (float)cos((double)x); }
static inline float law_asin(float x) { return (float)asin((double)x); }
static inline float law_acos(float x) { return (float)acos((double)x); }
#endif

#endif /* ATTEST_STARTER_ELEMENTARY_H */
