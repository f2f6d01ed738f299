/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * port.h - the parts that both units share: the profiles, as data, and tables of parameters.
 */
#ifndef ATTEST_STARTER_PORT_H
#define ATTEST_STARTER_PORT_H

#include <attest_cascade.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The two units. port.c lists them; each is defined in the file of its name. */
extern const attest_attitude_unit attitude_unit_table;
extern const attest_rate_unit rate_unit_table;

/* ---- profiles --------------------------------------------------------------------------------*/

enum { PX4_V1_14_4, PX4_V1_15_4, PX4_V1_16_0, PX4_V1_17, PX4_V1_18, PROFILE_COUNT };

/* One version of the law. Each flag switches on the behaviour that its comment describes. */
typedef struct profile {
  const char* name;

  /* Rate unit. */
  bool yaw_torque_filter; /* low-pass on the yaw torque */

  /* Attitude unit, sticks. */
  bool ignores_heading_good; /* heading_good_for_control is not read */
  bool yaw_lock;             /* a centred yaw stick locks the heading; otherwise the yaw setpoint is
                              * the integral of the stick */
  bool yaw_expo_fixed;       /* the expo of the yaw stick is 0.6, not MPC_YAW_EXPO */
  bool keeps_lost_correction; /* with yaw_lock: the correction keeps its value while there is no
                               * unaided heading, and starts anew after that; otherwise it is 0 */
  bool hover_estimate;        /* centre of the throttle follows the hover thrust estimate */
  bool throttle_slews;        /* limits of the thrust slew after landing, take-off and arming */
  bool lowpass_as_average;    /* low-pass of the tilt is (1 - a) s + a x; otherwise s + a (x - s) */

  /* Attitude unit, all modes. */
  bool setpoint_first;  /* setpoint and estimator reset are taken at the start of every step, and
                         * the sticks set the law's setpoint directly */
  bool yaw_of_any_norm; /* heading of a quaternion without the assumption of norm 1 */
  bool reference_model; /* the law follows a model of the setpoint: see reference_model.h */
  uint8_t autotune_states[4]; /* in which autotune moves the vehicle: roll, pitch, yaw, test */
} profile;

/* Returns NULL if no profile has that name. */
const profile* profile_find(const char* name);

/* ---- parameters ------------------------------------------------------------------------------*/

/* The default of a parameter that a profile does not have. */
#define ABSENT NAN

/* A row of a unit's table: a float at `offset` of the unit's struct of parameters. */
typedef struct parameter {
  const char* name;
  size_t offset;
  float initial[PROFILE_COUNT];
} parameter;

/* The default in all profiles. */
#define SAME(value) \
  { (value), (value), (value), (value), (value) }

/* Fills `values`, the unit's struct of parameters, with the defaults of the profile. A field
 * without a parameter in this profile stays as it is. */
void parameters_initialise(const parameter table[], size_t count, const profile* selected,
                           void* values);

/* Returns ATTEST_OK, or ATTEST_INVALID for a name that the profile does not have. */
int parameters_set(const parameter table[], size_t count, const profile* selected, void* values,
                   const char* name, float value);

#endif /* ATTEST_STARTER_PORT_H */
