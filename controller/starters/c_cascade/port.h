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

/* The two units. port.c lists them; each is defined in the file of its name. */
extern const attest_attitude_unit attitude_unit_table;
extern const attest_rate_unit rate_unit_table;

/* ---- profiles --------------------------------------------------------------------------------*/

enum { PX4_V1_14_4, PX4_V1_15_4, PX4_V1_16_0, PROFILE_COUNT };

/* One version of the law. Each flag switches on the behaviour that its comment describes. */
typedef struct profile {
  const char* name;

  /* Rate unit. */
  bool yaw_torque_filter; /* low-pass on the yaw torque */

  /* Attitude unit, sticks. */
  bool yaw_lock;           /* a centred yaw stick locks the heading; otherwise the yaw setpoint is
                            * the integral of the stick */
  bool hover_estimate;     /* centre of the throttle follows the hover thrust estimate */
  bool throttle_slews;     /* limits of the thrust slew after landing, take-off and arming */
  bool lowpass_as_average; /* low-pass of the tilt is (1 - a) s + a x; otherwise s + a (x - s) */

  /* Attitude unit, all modes. */
  bool setpoint_first;  /* setpoint and estimator reset are taken at the start of every step, and
                         * the sticks set the law's setpoint directly */
  bool yaw_of_any_norm; /* heading of a quaternion without the assumption of norm 1 */
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
  { (value), (value), (value) }

/* Fills `values`, the unit's struct of parameters, with the defaults of the profile. */
void parameters_initialise(const parameter table[], size_t count, const profile* selected,
                           void* values);

/* Returns ATTEST_OK, or ATTEST_INVALID for a name that the profile does not have. */
int parameters_set(const parameter table[], size_t count, const profile* selected, void* values,
                   const char* name, float value);

#endif /* ATTEST_STARTER_PORT_H */
