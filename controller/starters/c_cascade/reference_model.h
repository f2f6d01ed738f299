/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * reference_model.h - v1.18: the setpoint of the attitude law does not jump.
 *
 * A second-order model, critically damped, moves a reference attitude towards each setpoint that
 * the unit takes, by the time since the previous one. Between setpoints the reference stands still.
 * The rates of the model are fed forward to the rates setpoint. The attitude law keeps the
 * reference attitude as its q_d; here are the rates.
 */
#ifndef ATTEST_STARTER_REFERENCE_MODEL_H
#define ATTEST_STARTER_REFERENCE_MODEL_H

#include "quaternion.h"

/* The parameters as set, in their own units. */
typedef struct reference_parameters {
  float frequency;        /* natural frequency [rad/s] */
  float feed_forward;     /* share of the model's rates that is fed forward */
  float feed_forward_max; /* [deg/s]; 0: no limit */
} reference_parameters;

typedef struct reference_model {
  float frequency;        /* [rad/s] at least 0.1 */
  float feed_forward;     /* [0..1] */
  float feed_forward_max; /* [rad/s]; 0: no limit */

  /* In the frame of the reference attitude before its last move [rad/s]. */
  vec3 rates;   /* of the model towards the setpoint */
  vec3 command; /* the commanded yaw rate about world z; fed forward in full */
} reference_model;

/* Rates and command stay as they are. */
void reference_model_set_parameters(reference_model* m, const reference_parameters* p);

/* The first setpoint: the reference attitude is this setpoint, at rest. */
void reference_model_stop(reference_model* m);

/* Returns the reference attitude, which was `reference`, after `dt` [s]. `target` is the setpoint,
 * a unit quaternion; `yaw_rate` [rad/s] is about world z and counts if it is finite. */
quat reference_model_move(reference_model* m, quat reference, quat target, float yaw_rate,
                          float dt);

/* Adds the rates of the reference to `rates` [rad/s]. `to_body` turns vectors of the reference's
 * frame into the body frame. */
void reference_model_feed_forward(const reference_model* m, quat to_body, float rates[3]);

#endif /* ATTEST_STARTER_REFERENCE_MODEL_H */
