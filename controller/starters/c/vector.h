/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * vector.h - the few vector and matrix operations of the law, on plain arrays.
 *
 * Vectors are float[3], matrices float[9] row by row, quaternions float[4] {w, x, y, z} (Hamilton).
 * The order of every sum is part of the law: products are added in index order. In a dot product
 * and in a product of two matrices the sum starts at 0. In matrix times vector it starts at the
 * first product. The difference shows: 0 + (-0) is +0, so only matrix times vector gives -0.
 * Output arguments come last and must not overlap the inputs.
 */
#ifndef ATTEST_STARTER_VECTOR_H
#define ATTEST_STARTER_VECTOR_H

#include <math.h>

/* Passes NaN through, which fminf(fmaxf()) would not. */
static inline float clamp(float v, float lo, float hi) { return v < lo ? lo : (v > hi ? hi : v); }

static inline float dot(const float a[3], const float b[3]) {
  float sum = 0.0f;
  for (int i = 0; i < 3; i++) sum += a[i] * b[i];
  return sum;
}

static inline float length(const float a[3]) { return sqrtf(dot(a, a)); }

static inline void cross(const float a[3], const float b[3], float out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void column(const float m[9], int j, float out[3]) {
  for (int i = 0; i < 3; i++) out[i] = m[3 * i + j];
}

static inline void transpose(const float m[9], float out[9]) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) out[3 * i + j] = m[3 * j + i];
  }
}

static inline void multiply_vector(const float m[9], const float v[3], float out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
  }
}

static inline void multiply(const float a[9], const float b[9], float out[9]) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      float sum = 0.0f;
      for (int k = 0; k < 3; k++) sum += a[3 * i + k] * b[3 * k + j];
      out[3 * i + j] = sum;
    }
  }
}

/* Body to world. The quaternion is not normalised first: an all-zero one gives an all-zero R. */
static inline void rotation_matrix(const float q[4], float out[9]) {
  const float a = q[0], b = q[1], c = q[2], d = q[3];
  const float aa = a * a, bb = b * b, cc = c * c, dd = d * d;
  out[0] = aa + bb - cc - dd;
  out[1] = 2.0f * (b * c - a * d);
  out[2] = 2.0f * (a * c + b * d);
  out[3] = 2.0f * (b * c + a * d);
  out[4] = aa - bb + cc - dd;
  out[5] = 2.0f * (c * d - a * b);
  out[6] = 2.0f * (b * d - a * c);
  out[7] = 2.0f * (a * b + c * d);
  out[8] = aa - bb - cc + dd;
}

#endif /* ATTEST_STARTER_VECTOR_H */
