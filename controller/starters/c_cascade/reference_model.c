/* SPDX-License-Identifier: BSD-3-Clause */
/* The reference model of v1.18. NaN in a setpoint or a move stays in the reference permanently. */
#include "reference_model.h"

#include <stdbool.h>

#include "scalar.h"

void reference_model_set_parameters(reference_model* m, const reference_parameters* p) {
  m->frequency = max(p->frequency, 0.1f);
  m->feed_forward = clamp(p->feed_forward, 0.0f, 1.0f);
  m->feed_forward_max = max(rad(p->feed_forward_max), 0.0f);
}

void reference_model_stop(reference_model* m) {
  m->rates = (vec3){0.0f, 0.0f, 0.0f};
  m->command = (vec3){0.0f, 0.0f, 0.0f};
}

/* The exact solution of e'' = -w^2 e - 2 w e' over dt, for the rotation vector e that is left.
 * Returns how far the reference turns [rad], without the command, and updates the rates. */
static vec3 decay(reference_model* m, vec3 e, float dt) {
  const float w = m->frequency;
  const float k = w * dt;
  const float decayed = law_exp(-k);
  const float error_moved = 1.0f - (1.0f + k) * decayed;
  const float rates_moved = dt * decayed;
  const float error_gain = ((w * w) * dt) * decayed;
  const float rates_kept = (1.0f - k) * decayed;
  const vec3 moved = add(scale(e, error_moved), scale(m->rates, rates_moved));
  m->rates = add(scale(e, error_gain), scale(m->rates, rates_kept));
  return moved;
}

quat reference_model_move(reference_model* m, quat reference, quat target, float yaw_rate,
                          float dt) {
  const quat inverse = quat_inverse(reference);
  const vec3 world_z = quat_z_axis(inverse); /* in the frame of the reference */
  const bool commanded = isfinite(yaw_rate);
  m->command = commanded ? scale(world_z, yaw_rate) : (vec3){0.0f, 0.0f, 0.0f};

  /* Twice the sine of half the angle, not the angle: a large step ends short of the target. */
  const vec3 error = scale(quat_imaginary(quat_canonical(quat_multiply(inverse, target))), 2.0f);
  const vec3 moved = decay(m, error, dt);
  /* A commanded yaw rate is the whole rate about world z. The model must not add to it. */
  if (commanded && fabsf(yaw_rate) > FLT_EPSILON) {
    m->rates = subtract(m->rates, scale(world_z, dot(m->rates, world_z)));
  }
  const vec3 turn = add(moved, scale(m->command, dt));
  return quat_unit(quat_multiply(reference, quat_of_rotation_vector(turn)));
}

void reference_model_feed_forward(const reference_model* m, quat to_body, float rates[3]) {
  const vec3 command = quat_rotate(to_body, m->command);
  const vec3 model = scale(quat_rotate(to_body, m->rates), m->feed_forward);
  const float limit = m->feed_forward_max;
  const float commands[3] = {command.x, command.y, command.z};
  const float models[3] = {model.x, model.y, model.z};
  for (int i = 0; i < 3; i++) {
    const float fed = limit > 0.0f ? clamp(models[i], -limit, limit) : models[i];
    rates[i] = (rates[i] + commands[i]) + fed;
  }
}
