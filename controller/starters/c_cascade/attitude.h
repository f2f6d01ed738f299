/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * attitude.h - the attitude unit: attitude to body rates.
 *
 *     attitude_unit.c    the table of functions, the parameters, and one step
 *     attitude_law.c     attitude error to rates, without topics or time
 *     reference_model.c  v1.18: the attitude that the law follows, and its rates
 *     sticks.c           stabilized mode: sticks to an attitude setpoint
 *
 * World is NED, body is FRD, rates are [rad/s] about body x, y, z. Everything is binary32 and is
 * evaluated as written: compile with -ffp-contract=off and without -ffast-math.
 */
#ifndef ATTEST_STARTER_ATTITUDE_H
#define ATTEST_STARTER_ATTITUDE_H

#include <stdbool.h>
#include <stdint.h>

#include "port.h"
#include "quaternion.h"
#include "reference_model.h"
#include "scalar.h"

/* ---- the attitude law ------------------------------------------------------------------------*/

typedef struct attitude_law {
  float p[3];         /* [1/s] roll, pitch, yaw; yaw is divided by its weight */
  float yaw_weight;   /* [0..1] share of the yaw error that is corrected */
  float rate_max[3];  /* [rad/s] */
  bool has_reference; /* otherwise q_d and yaw_rate are those of the setpoint */
  quat q_d;           /* desired attitude; that of the reference model, if there is one */
  float yaw_rate;     /* [rad/s] about world z, fed forward if finite */
  reference_model reference;
} attitude_law;

void attitude_law_set_gains(attitude_law* law, const float p[3], float yaw_weight,
                            const float rate_max_deg[3]);

/* `elapsed` [s] is the time since the previous setpoint, 0 for the first one. */
void attitude_law_set_setpoint(attitude_law* law, quat q_d, float yaw_rate, float elapsed);

/* Turns the setpoint by `delta`, by which the estimator turned its attitude: the error stays. */
void attitude_law_adapt(attitude_law* law, quat delta);

/* The rates [rad/s] that turn the vehicle from attitude q towards the setpoint. */
void attitude_law_rates(const attitude_law* law, quat q, float rates[3]);

/* ---- one unit --------------------------------------------------------------------------------*/

/* The parameters as set, in their own units. The host changes them only before a step that has
 * parameter_update set, so the law may read them in every step. */
typedef struct attitude_parameters {
  float p[3], yaw_weight;             /* roll, pitch, yaw [1/s] */
  float rate_max[3];                  /* [deg/s] */
  float tilt_max, tilt_tau;           /* [deg], [s] */
  float yaw_max, yaw_tau, yaw_expo;   /* [deg/s], [s], [1] */
  float hold_deadzone;                /* of the yaw stick */
  float throttle_min, throttle_hover; /* thrust [0..1] */
  float throttle_max, throttle_curve; /* thrust [0..1]; 0, 1 or 2 */
  float airmode, spoolup_time;        /* 0, 1 or 2; [s] */
  reference_parameters reference;
} attitude_parameters;

typedef struct attitude_setpoint {
  uint64_t timestamp; /* [us] */
  quat q_d;
  float thrust[3]; /* [-1..1] along body x, y, z */
  float yaw_rate;  /* [rad/s] */
} attitude_setpoint;

/* State of sticks.c. */
typedef struct stick_state {
  lowpass roll, pitch; /* of the tilt [rad] */
  float yaw_sp;        /* [rad]; with yaw_lock, not finite if no heading is locked */
  float throttle_min;  /* thrust with the stick at its lowest, slews */
  float throttle_max;  /* limit of the thrust, slews up after arming */
  float hover;         /* thrust with a centred stick, slews */

  /* With yaw_lock. */
  lowpass yaw_rate;  /* [rad/s] */
  lowpass yaw_error; /* estimated minus unaided heading [rad] */
  float yaw_ref;     /* estimated minus unaided heading when last steady [rad] */
  float correction;  /* [rad] */
  bool lost;         /* no unaided heading in the last step with sticks */
  bool converging;   /* the estimate of the heading changes without a turn of the vehicle */

  /* Without yaw_lock. */
  bool restart_yaw; /* the next step with sticks begins at the present heading */
} stick_state;

typedef struct attitude_unit {
  const profile* profile;
  attitude_parameters parameters;
  bool started;  /* false until the first step has read the parameters */
  uint64_t last; /* [us] timestamp_sample of the previous step */

  /* Topics as last latched. */
  attitude_setpoint sample; /* newest vehicle_attitude_setpoint, external or of the sticks */
  bool sample_pending;      /* not latched yet */
  float roll, pitch, yaw, throttle; /* sticks */
  bool attitude_controlled;
  bool sticks_enabled; /* manual, without altitude, velocity and position */
  bool rotary_wing, vtol, in_transition, tailsitter;
  bool spooled_up;
  bool landed;
  bool heading_good;
  float unaided_heading; /* [rad]; not finite if not available */
  float hover_estimate;  /* [0..1]; not finite if not available */

  attitude_law law;
  float thrust[3];
  uint64_t setpoint_time; /* [us] timestamp of the setpoint that the law has */
  uint8_t reset_counter;  /* of the estimator, as last seen */

  float stick_tilt_max; /* [rad] */
  float stick_yaw_max;  /* [rad/s] */
  stick_state sticks;
} attitude_unit;

/* The heading of q [rad], computed as the profile does. */
static inline float attitude_heading(const attitude_unit* u, quat q) {
  const bool any_norm = u->profile->yaw_of_any_norm;
  return quat_yaw(q, any_norm ? quat_r00_of_any_norm(q) : quat_r00_of_norm_1(q));
}

/* ---- sticks ----------------------------------------------------------------------------------*/

/* Call after parameters were read. */
void sticks_read_parameters(attitude_unit* u);

/* The setpoint of the sticks for attitude q. Its timestamp is left 0. */
attitude_setpoint sticks_setpoint(attitude_unit* u, quat q, float dt);

/* Call if the sticks do not make the setpoint of this step. `run`: the unit controls attitude. */
void sticks_release(attitude_unit* u, quat q, bool run);

/* Call after the estimator turned the heading by `turn` [rad]. */
void sticks_adapt(attitude_unit* u, float turn);

/* Call at the end of each step. `used`: the sticks made the setpoint. */
void sticks_finish(attitude_unit* u, bool used, float dt);

#endif /* ATTEST_STARTER_ATTITUDE_H */
