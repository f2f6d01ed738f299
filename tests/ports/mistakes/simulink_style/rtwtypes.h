/* SPDX-License-Identifier: BSD-3-Clause */
/* rtwtypes.h - the number types of the model, and its helpers for non-finite values. */
#ifndef RTW_TYPES_H
#define RTW_TYPES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

typedef float real_T; /* the model is in single precision */
typedef bool boolean_T;
typedef int32_t int32_T;
typedef uint32_t uint32_T;
typedef uint64_t uint64_T;

static inline boolean_T rtIsNaNF(real_T value) { return value != value; }

static inline boolean_T rtIsInfF(real_T value) { return value == INFINITY || value == -INFINITY; }

/* 0 for (0, 0), whatever the signs of the zeros. */
static inline real_T rt_atan2f_snf(real_T u0, real_T u1) {
  real_T y;
  if (rtIsNaNF(u0) || rtIsNaNF(u1)) {
    y = NAN;
  } else if (rtIsInfF(u0) && rtIsInfF(u1)) {
    y = atan2f(u0 > 0.0F ? 1.0F : -1.0F, u1 > 0.0F ? 1.0F : -1.0F);
  } else if (u1 == 0.0F) {
    if (u0 > 0.0F) {
      y = 1.57079633F;
    } else if (u0 < 0.0F) {
      y = -1.57079633F;
    } else {
      y = 0.0F;
    }
  } else {
    y = atan2f(u0, u1);
  }
  return y;
}

#endif /* RTW_TYPES_H */
