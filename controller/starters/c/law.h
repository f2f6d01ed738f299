/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * law.h - the multicopter attitude control law of PX4 v1.5.5 mc_att_control, in plain C11.
 *
 *     unit.c        the C ABI, the parameters, and one step: selects the loops and their inputs
 *     attitude.c    outer loop: attitude error -> body rates setpoint
 *     tailsitter.c  outer loop of a tailsitter that may have to recover from a large tilt
 *     rate.c        inner loop: rate error -> actuator controls
 *
 * World is NED, body is FRD, rates are [rad/s] about body x, y, z. Everything is binary32 and is
 * evaluated as written: compile with -ffp-contract=off and without -ffast-math.
 */
#ifndef ATTEST_STARTER_LAW_H
#define ATTEST_STARTER_LAW_H

#include <attest_unit.h>
#include <stdbool.h>
#include <stdint.h>

#define LAW_PI 3.14159265358979323846f

static inline float rad(float degrees) { return (degrees / 180.0f) * LAW_PI; }

typedef enum profile { PROFILE_PX4_V1_5_5, PROFILE_PX4_V1_3_4 } profile;

/* The parameters as set, in their own units (degrees where PX4 has degrees). */
typedef struct parameters {
  float roll_p, roll_tc, roll_rate_p, roll_rate_i, roll_rate_d, roll_rate_ff;
  float pitch_p, pitch_tc, pitch_rate_p, pitch_rate_i, pitch_rate_d, pitch_rate_ff;
  float yaw_p, yaw_rate_p, yaw_rate_i, yaw_rate_d, yaw_rate_ff, yaw_ff;
  float roll_rate_max, pitch_rate_max, yaw_rate_max, yaw_auto_max; /* [deg/s] */
  float acro_roll_max, acro_pitch_max, acro_yaw_max;               /* [deg/s] */
  float rattitude_threshold, tpa_break, tpa_slope, battery_scale_enabled;
  float weather_vane_scale, vtol_type, recovery_enabled, circuit_breaker;
} parameters;

/* The parameters as the law uses them. Computed at the first step and at parameter_update. */
typedef struct gains {
  float att_p[3];                                    /* [1/s] */
  float rate_p[3], rate_i[3], rate_d[3], rate_ff[3]; /* control per rad/s, rad, rad/s^2, rad/s */
  float mc_rate_max[3], auto_rate_max[3], acro_rate_max[3]; /* [rad/s] */
  float yaw_ff, rattitude_threshold, tpa_break, tpa_slope, weather_vane_scale;
  bool battery_scale_enabled, circuit_breaker_open;
} gains;

/* One controller, with all its state from step to step. */
typedef struct controller {
  profile profile;
  parameters parameters;
  gains gains;

  attest_inputs copy;       /* each topic as it was last latched */
  uint32_t pending;         /* ATTEST_UPDATED_ bits of samples not latched yet */
  bool started;             /* false until the first step has begun */
  bool have_vehicle_status; /* the first vehicle_status selects the topics to publish on */
  bool on_virtual_topics;   /* publishes on those of a VTOL; still reads vehicle_rates_setpoint */

  bool tailsitter; /* tailsitter.c replaces attitude.c; decided at the first step */
  bool recovering; /* tailsitter.c: recovers from a large tilt */
  float rates_sp[3], thrust_sp;
  float rates_prev[3];
  float rates_sp_prev[3]; /* px4-v1.3.4 only: its feed-forward acts on the change */
  float rates_int[3];     /* the integral parts of the rate loop */
} controller;

/* attitude.c: sets c->rates_sp from the latched attitude and attitude setpoint. May zero the yaw
 * integral (weather-vane). */
void attitude_law(controller* c);

/* tailsitter.c: the same, for a tailsitter with recovery enabled. */
void tailsitter_law(controller* c);

/* rate.c: control[0..2] (roll, pitch, yaw, not yet made finite) from c->rates_sp; then updates the
 * integrals. `dt` in [s], not 0. */
void rate_law(controller* c, float dt, float control[3]);

#endif /* ATTEST_STARTER_LAW_H */
