/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * scalar.h - the functions of one number that both units share: limits, angles, filters and stick
 * curves.
 *
 * Every comparison is written so that a NaN takes the branch that the law gives it. fminf and fmaxf
 * would drop a NaN, so they are not used. Filters keep their state in the instance.
 */
#ifndef ATTEST_STARTER_SCALAR_H
#define ATTEST_STARTER_SCALAR_H

#include <float.h>
#include <math.h>
#include <stdint.h>

static inline float rad(float degrees) { return degrees * 0.0174532924f; }

/* Passes NaN through. */
static inline float clamp(float v, float lo, float hi) { return v < lo ? lo : (v > hi ? hi : v); }

/* Both return b if a or b is NaN. */
static inline float min(float a, float b) { return a < b ? a : b; }
static inline float max(float a, float b) { return a > b ? a : b; }

/* The angle x [rad] in -pi .. pi. */
static inline float wrap(float x) {
  const float lo = -3.14159274f;
  const float hi = 3.14159274f;
  if (lo <= x && x < hi) return x;
  return x - 6.28318548f * floorf((x - lo) * 0.159154937f);
}

/* Seconds from `from` to `to` [us]. The difference is unsigned, so that time which goes back gives
 * a very large value. */
static inline float seconds(uint64_t from, uint64_t to) { return (float)(to - from) * 1e-6f; }

/* The same, limited to lo .. hi. */
static inline float seconds_between(uint64_t from, uint64_t to, float lo, float hi) {
  return clamp(seconds(from, to), lo, hi);
}

/* ---- filters ---------------------------------------------------------------------------------*/

typedef struct lowpass {
  float state;
  float weight; /* kept while tau + dt is at most FLT_EPSILON */
} lowpass;

static inline float lowpass_weight(lowpass* f, float tau, float dt) {
  const float n = tau + dt;
  if (n > FLT_EPSILON) f->weight = dt / n;
  return f->weight;
}

static inline float lowpass_update(lowpass* f, float tau, float dt, float x) {
  f->state = f->state + lowpass_weight(f, tau, dt) * (x - f->state);
  return f->state;
}

/* The next value of `state`, which follows x by at most rate * dt. */
static inline float slew(float state, float rate, float dt, float x) {
  const float step = rate * dt;
  return state + clamp(x - state, -step, step);
}

/* ---- curves ----------------------------------------------------------------------------------*/

/* The straight line from (x0, y0) to (x1, y1), constant outside. */
static inline float line(float v, float x0, float x1, float y0, float y1) {
  if (v <= x0) return y0;
  if (v > x1) return y1;
  const float gradient = (y1 - y0) / (x1 - x0);
  return (gradient * v) + (y0 - (gradient * x0));
}

/* A blend of linear (e = 0) and cubic (e = 1). */
static inline float expo(float v, float e) {
  const float x = clamp(v, -1.0f, 1.0f);
  const float cubic = clamp(e, 0.0f, 1.0f);
  return (1.0f - cubic) * x + cubic * x * x * x;
}

/* Steeper near full deflection: g = 0 is expo(). */
static inline float superexpo(float v, float e, float g) {
  const float x = clamp(v, -1.0f, 1.0f);
  const float steep = clamp(g, 0.0f, 0.99f);
  return (expo(x, e) * (1.0f - steep)) / (1.0f - fabsf(x) * steep);
}

/* 0 within +-z. Written as a product with 0, not as a branch, so that a NaN in v stays NaN. */
static inline float deadzone(float v, float z) {
  const float x = clamp(v, -1.0f, 1.0f);
  const float width = clamp(z, 0.0f, 0.99f);
  const float sign = x > 0.0f ? 1.0f : (x < 0.0f ? -1.0f : 0.0f);
  return ((x - sign * width) / (1.0f - width)) * (fabsf(x) > width ? 1.0f : 0.0f);
}

#endif /* ATTEST_STARTER_SCALAR_H */
