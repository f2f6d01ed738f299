/* SPDX-License-Identifier: BSD-3-Clause */
/* The order of each sum and product is part of the law: another order changes the last bits. */
#include "law.h"

#include <float.h>
#include <math.h>

#include "elementary.h"

typedef struct {
  float x, y, z;
} vector;

typedef struct {
  float w, x, y, z;
} quaternion;

/* Passes NaN. */
static float clamp(float value, float low, float high) {
  return value < low ? low : (value > high ? high : value);
}

static float dot(vector a, vector b) { return 0.0f + a.x * b.x + a.y * b.y + a.z * b.z; }

static vector cross(vector a, vector b) {
  return (vector){a.y * b.z - a.z * b.y, -a.x * b.z + a.z * b.x, a.x * b.y - a.y * b.x};
}

static float norm_squared(quaternion q) { return q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z; }

static quaternion scaled(quaternion q, float factor) {
  return (quaternion){q.w * factor, q.x * factor, q.y * factor, q.z * factor};
}

static quaternion unit(quaternion q) { return scaled(q, 1.0f / sqrtf(norm_squared(q))); }

static quaternion inverse(quaternion q) {
  const float n = norm_squared(q);
  return (quaternion){q.w / n, -q.x / n, -q.y / n, -q.z / n};
}

static quaternion product(quaternion q, quaternion p) {
  return (quaternion){
      q.w * p.w - q.x * p.x - q.y * p.y - q.z * p.z, q.x * p.w + q.w * p.x - q.z * p.y + q.y * p.z,
      q.y * p.w + q.z * p.x + q.w * p.y - q.x * p.z, q.z * p.w - q.y * p.x + q.x * p.y + q.w * p.z};
}

/* Of the two quaternions of a rotation, the one whose first component other than 0 is positive. */
static quaternion canonical(quaternion q) {
  const float components[] = {q.w, q.x, q.y, q.z};
  for (int i = 0; i < 4; ++i) {
    if (fabsf(components[i]) > FLT_EPSILON) return scaled(q, components[i] > 0.0f ? 1.0f : -1.0f);
  }
  return q;
}

/* The z axis of the rotated frame: of body to world, the direction opposite to thrust. */
static vector z_axis(quaternion q) {
  return (vector){2.0f * (q.w * q.y + q.x * q.z), 2.0f * (q.y * q.z - q.w * q.x),
                  q.w * q.w - q.x * q.x - q.y * q.y + q.z * q.z};
}

/* The axis to which v has the largest angle. */
static vector most_perpendicular_axis(vector v) {
  const float x = fabsf(v.x), y = fabsf(v.y), z = fabsf(v.z);
  if (x < y && x < z) return (vector){1.0f, 0.0f, 0.0f};
  if (!(x < y) && y < z) return (vector){0.0f, 1.0f, 0.0f};
  return (vector){0.0f, 0.0f, 1.0f};
}

/* The shortest rotation that turns a into b. If they are opposite, half a turn about some axis. */
static quaternion between(vector a, vector b) {
  vector axis = cross(a, b);
  float w = dot(a, b);
  if (sqrtf(dot(axis, axis)) < 1e-5f && w < 0.0f) {
    axis = cross(a, most_perpendicular_axis(a));
    w = 0.0f;
  } else {
    w = w + sqrtf(dot(a, a) * dot(b, b));
  }
  return unit((quaternion){w, axis.x, axis.y, axis.z});
}

/* The attitude that has the thrust direction of q_d, and the heading of q as far as it can. */
static quaternion tilted(quaternion q, quaternion q_d) {
  const float opposite = 0.999989986f;
  const quaternion tilt = between(z_axis(q), z_axis(q_d));
  if (fabsf(tilt.x) > opposite || fabsf(tilt.y) > opposite) return q_d;
  return product(tilt, q);
}

void attitude_law(const float q_now[4], const float q_wanted[4], float yaw_rate, const float p[3],
                  const float rate_max[3], float yaw_weight, float rates_sp[3]) {
  const quaternion q = {q_now[0], q_now[1], q_now[2], q_now[3]};
  const quaternion q_d = unit((quaternion){q_wanted[0], q_wanted[1], q_wanted[2], q_wanted[3]});
  const float weight = clamp(yaw_weight, 0.0f, 1.0f);

  /* Tilt first, then as much of the yaw error as the weight says. */
  const quaternion reduced = tilted(q, q_d);
  const quaternion mix = canonical(product(inverse(reduced), q_d));
  const float mix_w = clamp(mix.w, -1.0f, 1.0f), mix_z = clamp(mix.z, -1.0f, 1.0f);
  const quaternion yaw = {law_cos(weight * law_acos(mix_w)), 0.0f, 0.0f,
                          law_sin(weight * law_asin(mix_z))};
  const quaternion error = canonical(product(inverse(q), product(reduced, yaw)));

  /* The weight made the yaw error smaller. This gain makes up for it. */
  const float yaw_p = weight > 1e-4f ? p[2] / weight : p[2];
  rates_sp[0] = error.x * 2.0f * p[0];
  rates_sp[1] = error.y * 2.0f * p[1];
  rates_sp[2] = error.z * 2.0f * yaw_p;

  if (isfinite(yaw_rate)) {
    const vector world_z = z_axis(inverse(q)); /* in the body frame */
    rates_sp[0] += world_z.x * yaw_rate;
    rates_sp[1] += world_z.y * yaw_rate;
    rates_sp[2] += world_z.z * yaw_rate;
  }
  for (int i = 0; i < 3; ++i) rates_sp[i] = clamp(rates_sp[i], -rate_max[i], rate_max[i]);
}

void rate_law(const rate_gains* gains, const float rates[3], const float derivative[3],
              const float rates_sp[3], const uint8_t positive[3], const uint8_t negative[3],
              bool landed, float dt_s, float integral[3], float torque[3]) {
  const float no_integral_error = 6.98131704f; /* [rad/s] 400 deg/s: too large to integrate */
  for (int i = 0; i < 3; ++i) {
    float error = rates_sp[i] - rates[i];
    torque[i] = gains->p[i] * error + integral[i] - gains->d[i] * derivative[i] +
                gains->ff[i] * rates_sp[i];
    if (landed) continue;
    /* No integral against a saturated motor. A NaN becomes 0 here. */
    if (positive[i]) error = error < 0.0f ? error : 0.0f;
    if (negative[i]) error = error > 0.0f ? error : 0.0f;
    const float ratio = error / no_integral_error;
    const float left = 1.0f - ratio * ratio;
    const float share = 0.0f > left ? 0.0f : left; /* the larger the error, the less integral */
    const float sum = integral[i] + share * gains->i[i] * error * dt_s;
    if (isfinite(sum)) integral[i] = clamp(sum, -gains->integral_max[i], gains->integral_max[i]);
  }
}
