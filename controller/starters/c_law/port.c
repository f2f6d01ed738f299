/* SPDX-License-Identifier: BSD-3-Clause */
#include <attest_law.h>
#include <stdlib.h>
#include <string.h>

#include "law.h"

/* A law in its first state is its integral, three zeros. The attitude law has no state. */
static void* create_rate(const char* profile) {
  static const char* const known[] = {"px4-v1.14.4", "px4-v1.15.4", "px4-v1.16.0", "px4-v1.17",
                                      "px4-v1.18"};
  for (int i = 0; i < 5; ++i) {
    if (strcmp(profile, known[i]) == 0) return calloc(3, sizeof(float));
  }
  return NULL;
}

/* The attitude law of v1.18 has a reference model. */
static void* create_attitude(const char* profile) {
  return strcmp(profile, "px4-v1.18") == 0 ? NULL : create_rate(profile);
}

static int step_attitude(void* self, const attest_attitude_law_inputs* in,
                         attest_attitude_law_outputs* out) {
  (void)self;
  float rates_sp[3];
  attitude_law(in->vehicle_attitude.q, in->vehicle_attitude_setpoint.q_d,
               in->vehicle_attitude_setpoint.yaw_sp_move_rate, in->attitude_gains.p,
               in->attitude_gains.rate_max, in->attitude_gains.yaw_weight, rates_sp);
  memcpy(&out->vehicle_rates_setpoint, rates_sp, sizeof(rates_sp));
  return ATTEST_OK;
}

static int step_rate(void* integral, const attest_rate_law_inputs* in,
                     attest_rate_law_outputs* out) {
  const rate_gains gains = {in->rate_gains.p, in->rate_gains.i, in->rate_gains.d, in->rate_gains.ff,
                            in->rate_gains.integral_max};
  const float rates_sp[3] = {in->vehicle_rates_setpoint.roll, in->vehicle_rates_setpoint.pitch,
                             in->vehicle_rates_setpoint.yaw};
  if (in->law.reset) memset(integral, 0, 3 * sizeof(float));
  rate_law(&gains, in->vehicle_angular_velocity.xyz, in->vehicle_angular_velocity.xyz_derivative,
           rates_sp, in->saturation.positive, in->saturation.negative, in->law.landed, in->law.dt,
           integral, out->vehicle_torque_setpoint.xyz);
  memcpy(&out->rate_ctrl_status, integral, 3 * sizeof(float));
  return ATTEST_OK;
}

static const void* extension(const char* id) {
  static const attest_attitude_law attitude = {create_attitude, free, step_attitude};
  static const attest_rate_law rate = {create_rate, free, step_rate};
  if (strcmp(id, ATTEST_EXTENSION_ATTITUDE_LAW) == 0) return &attitude;
  return strcmp(id, ATTEST_EXTENSION_RATE_LAW) == 0 ? &rate : NULL;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {ATTEST_UNIT_ABI_VERSION, "attest-starter-c-law", "1.0",
                                   .extension = extension};
  return &unit;
}
