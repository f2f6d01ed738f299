/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * quaternion.h - vectors and quaternions of the attitude unit.
 *
 * Quaternions are Hamilton, scalar first, body FRD to world NED. They may have any norm: only
 * quat_unit() and quat_between() normalise. The order of every sum, and products with a factor of
 * 0, are part of the law. They show in the last bits, in the sign of a zero and in NaN.
 */
#ifndef ATTEST_STARTER_QUATERNION_H
#define ATTEST_STARTER_QUATERNION_H

#include <float.h>
#include <math.h>

#include "elementary.h"

typedef struct vec3 {
  float x, y, z;
} vec3;

typedef struct quat {
  float w, x, y, z;
} quat;

/* ---- vectors ---------------------------------------------------------------------------------*/

/* The sum starts at 0, so that the result is never -0. */
static inline float dot(vec3 a, vec3 b) { return 0.0f + a.x * b.x + a.y * b.y + a.z * b.z; }

static inline float length(vec3 v) { return sqrtf(dot(v, v)); }

static inline vec3 scale(vec3 v, float s) { return (vec3){v.x * s, v.y * s, v.z * s}; }

static inline vec3 add(vec3 a, vec3 b) { return (vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }

static inline vec3 subtract(vec3 a, vec3 b) { return (vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }

static inline vec3 cross(vec3 a, vec3 b) {
  return (vec3){a.y * b.z - a.z * b.y, -a.x * b.z + a.z * b.x, a.x * b.y - a.y * b.x};
}

/* The axis along which v has its component of smallest magnitude. The order of the comparisons is
 * part of the law: it decides ties. */
static inline vec3 smallest_axis(vec3 v) {
  const float x = fabsf(v.x), y = fabsf(v.y), z = fabsf(v.z);
  const vec3 x_axis = {1.0f, 0.0f, 0.0f};
  const vec3 y_axis = {0.0f, 1.0f, 0.0f};
  const vec3 z_axis = {0.0f, 0.0f, 1.0f};
  if (x < y) return x < z ? x_axis : z_axis;
  return y < z ? y_axis : z_axis;
}

/* ---- quaternions -----------------------------------------------------------------------------*/

static inline quat quat_of(const float q[4]) { return (quat){q[0], q[1], q[2], q[3]}; }

static inline float quat_dot(quat a, quat b) {
  return 0.0f + a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline quat quat_scale(quat q, float s) {
  return (quat){q.w * s, q.x * s, q.y * s, q.z * s};
}

/* Not guarded: a zero quaternion becomes NaN. */
static inline quat quat_unit(quat q) { return quat_scale(q, 1.0f / sqrtf(quat_dot(q, q))); }

static inline quat quat_multiply(quat q, quat p) {
  return (quat){
      q.w * p.w - q.x * p.x - q.y * p.y - q.z * p.z, q.x * p.w + q.w * p.x - q.z * p.y + q.y * p.z,
      q.y * p.w + q.z * p.x + q.w * p.y - q.x * p.z, q.z * p.w - q.y * p.x + q.x * p.y + q.w * p.z};
}

static inline quat quat_inverse(quat q) {
  const float n = quat_dot(q, q);
  return (quat){q.w / n, -q.x / n, -q.y / n, -q.z / n};
}

static inline vec3 quat_imaginary(quat q) { return (vec3){q.x, q.y, q.z}; }

/* The vector v, turned by q. */
static inline vec3 quat_rotate(quat q, vec3 v) {
  const quat pure = {0.0f, v.x, v.y, v.z};
  return quat_imaginary(quat_multiply(quat_multiply(q, pure), quat_inverse(q)));
}

/* q or -q, which are the same rotation: the one whose first component that is not almost 0 is
 * positive. It describes the shorter of the two ways round. */
static inline quat quat_canonical(quat q) {
  float first = q.w;
  if (!(fabsf(first) > FLT_EPSILON)) first = q.x;
  if (!(fabsf(first) > FLT_EPSILON)) first = q.y;
  if (!(fabsf(first) > FLT_EPSILON)) first = q.z;
  if (!(fabsf(first) > FLT_EPSILON)) return q;
  return quat_scale(q, first > 0.0f ? 1.0f : -1.0f);
}

/* The body's z axis in world axes: the third column of the rotation matrix. */
static inline vec3 quat_z_axis(quat q) {
  return (vec3){2.0f * (q.w * q.y + q.x * q.z), 2.0f * (q.y * q.z - q.w * q.x),
                q.w * q.w - q.x * q.x - q.y * q.y + q.z * q.z};
}

/* The shortest rotation that turns a into b. Opposite vectors turn about an axis that is
 * perpendicular to a. */
static inline quat quat_between(vec3 a, vec3 b) {
  vec3 axis = cross(a, b);
  float w = dot(a, b);
  if (w < 0.0f && length(axis) < 1e-5f) {
    w = 0.0f;
    axis = cross(a, smallest_axis(a));
  } else {
    w = w + sqrtf(dot(a, a) * dot(b, b));
  }
  return quat_unit((quat){w, axis.x, axis.y, axis.z});
}

/* The rotation about the vector v by the angle |v| [rad]. */
static inline quat quat_of_rotation_vector(vec3 v) {
  const float angle = length(v);
  if (angle < 1e-10f) return (quat){1.0f, 0.0f, 0.0f, 0.0f};
  const vec3 imaginary = scale(scale(v, 1.0f / angle), law_sin(angle / 2.0f));
  return (quat){law_cos(angle / 2.0f), imaginary.x, imaginary.y, imaginary.z};
}

static inline quat quat_of_yaw(float yaw) {
  return (quat){law_cos(yaw / 2.0f), 0.0f, 0.0f, law_sin(yaw / 2.0f)};
}

/* Element 0, 0 of the rotation matrix, in the two ways in which the profiles compute it. They agree
 * only for unit quaternions. */
static inline float quat_r00_of_norm_1(quat q) { return 1.0f - 2.0f * (q.y * q.y + q.z * q.z); }
static inline float quat_r00_of_any_norm(quat q) {
  return q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z;
}

/* The heading [rad], also with the nose straight up or down, where it cannot be told from roll. */
static inline float quat_yaw(quat q, float r00) {
  const float sin_pitch = -(2.0f * (q.x * q.z - q.w * q.y));
  /* The law asks whether the pitch is within 0.001 rad of a quarter turn. asin(0.99) is 0.14 rad
   * short of it, so most steps can save the asin. */
  if (!(fabsf(sin_pitch) < 0.99f)) {
    const float pitch = law_asin(sin_pitch);
    const float r12 = 2.0f * (q.y * q.z - q.w * q.x);
    const float r02 = 2.0f * (q.w * q.y + q.x * q.z);
    if (fabsf(pitch - 1.57079637f) < 0.001f) return law_atan2(r12, r02);
    if (fabsf(pitch + 1.57079637f) < 0.001f) return law_atan2(-r12, -r02);
  }
  return law_atan2(2.0f * (q.x * q.y + q.w * q.z), r00);
}

#endif /* ATTEST_STARTER_QUATERNION_H */
