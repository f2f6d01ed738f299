/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * The attitude law: thrust axis first, then yaw.
 *
 * After D. Brescianini, M. Hehn, R. D'Andrea, "Nonlinear Quadrocopter Attitude Control" (2013).
 */
#include "attitude.h"
#include "elementary.h"

void attitude_law_set_gains(attitude_law* law, const float p[3], float yaw_weight,
                            const float rate_max_deg[3]) {
  law->yaw_weight = clamp(yaw_weight, 0.0f, 1.0f);
  for (int i = 0; i < 3; i++) {
    law->p[i] = p[i];
    law->rate_max[i] = rad(rate_max_deg[i]);
  }
  /* The weight makes the yaw error smaller. Without this division MC_YAW_P would lose effect. */
  if (law->yaw_weight > 1e-4f) law->p[2] = law->p[2] / law->yaw_weight;
}

void attitude_law_set_setpoint(attitude_law* law, quat q_d, float yaw_rate, float elapsed) {
  const quat given = quat_unit(q_d);
  if (law->has_reference && elapsed > 0.0f) {
    law->q_d = reference_model_move(&law->reference, law->q_d, given, yaw_rate, elapsed);
  } else {
    law->q_d = given;
    law->yaw_rate = yaw_rate;
    reference_model_stop(&law->reference);
  }
}

void attitude_law_adapt(attitude_law* law, quat delta) {
  law->q_d = quat_unit(quat_multiply(delta, law->q_d));
}

/* q turned the shortest way to the thrust direction of the setpoint, without yaw. */
static quat reduced_setpoint(quat q, quat q_d) {
  const quat r = quat_between(quat_z_axis(q), quat_z_axis(q_d));
  /* Opposite thrust directions: the axis of r is arbitrary, so turn straight to the setpoint. */
  if (fabsf(r.x) > 0.999989986f || fabsf(r.y) > 0.999989986f) return q_d;
  return quat_multiply(r, q);
}

/* The attitude to turn to now: the reduced setpoint, with a part of the remaining yaw. */
static quat target(const attitude_law* law, quat q) {
  const quat reduced = reduced_setpoint(q, law->q_d);
  /* The remaining turn is about body z. Its components can round to more than 1, where acos and
   * asin give NaN. */
  const quat mix = quat_canonical(quat_multiply(quat_inverse(reduced), law->q_d));
  const float cosine = clamp(mix.w, -1.0f, 1.0f);
  const float sine = clamp(mix.z, -1.0f, 1.0f);
  const quat yaw = {law_cos(law->yaw_weight * law_acos(cosine)), 0.0f, 0.0f,
                    law_sin(law->yaw_weight * law_asin(sine))};
  return quat_multiply(reduced, yaw);
}

static void feed_yaw_rate(const attitude_law* law, quat inverse, float rates[3]) {
  if (!isfinite(law->yaw_rate)) return;
  const vec3 world_z = quat_z_axis(inverse); /* in body axes */
  rates[0] = rates[0] + world_z.x * law->yaw_rate;
  rates[1] = rates[1] + world_z.y * law->yaw_rate;
  rates[2] = rates[2] + world_z.z * law->yaw_rate;
}

void attitude_law_rates(const attitude_law* law, quat q, float rates[3]) {
  const quat inverse = quat_inverse(q);
  const quat e = quat_canonical(quat_multiply(inverse, target(law, q)));
  rates[0] = (e.x * 2.0f) * law->p[0];
  rates[1] = (e.y * 2.0f) * law->p[1];
  rates[2] = (e.z * 2.0f) * law->p[2];

  if (law->has_reference) {
    reference_model_feed_forward(&law->reference, quat_multiply(inverse, law->q_d), rates);
  } else {
    feed_yaw_rate(law, inverse, rates);
  }
  for (int i = 0; i < 3; i++) rates[i] = clamp(rates[i], -law->rate_max[i], law->rate_max[i]);
}
