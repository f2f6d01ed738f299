/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: never pass. Outputs of the starter, changed by CHANGE(out, step):
 *
 *     negated_torque       fail at every level: roll, pitch and yaw controls have the other sign
 *     rates_times_100      fail at every level: rates setpoints times -100
 *     nan_integrals        non-finite at every level: integrals are NaN
 *     nan_once             non-finite, in flight too: an integral is NaN in one step
 *     wrong_unsupported    fail: negated torque, and ATTEST_UNSUPPORTED from step 20 on
 *     right_unsupported    unsupported: its outputs before step 20 are right
 */
#include <math.h>

#include "../wrapper.h"

#ifndef UNSUPPORTED_FROM
#define UNSUPPORTED_FROM UINT32_MAX
#endif

/* A step updates `out`, which the host keeps from step to step. Therefore changes are made to a
 * copy. */
typedef struct changed {
  wrapper law;
  attest_outputs out;
} changed;

static void* create(const char* profile) {
  wrapper* const law = wrapper_create(profile);
  if (law == NULL) return NULL;
  changed* self = calloc(1, sizeof *self);
  if (self != NULL) self->law = *law;
  free(law);
  return self;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  changed* const port = self;
  if (port->law.step_index >= UNSUPPORTED_FROM) return ATTEST_UNSUPPORTED;
  const int result = wrapper_step(&port->law, in, &port->out);
  *out = port->out;
#if defined(NEGATED_TORQUE)
  for (int i = 0; i < 3; i++) out->actuator_controls_0.control[i] *= -1.0f;
#elif defined(RATES_TIMES)
  out->vehicle_rates_setpoint.roll *= RATES_TIMES;
  out->vehicle_rates_setpoint.pitch *= RATES_TIMES;
  out->vehicle_rates_setpoint.yaw *= RATES_TIMES;
#elif defined(NAN_INTEGRALS)
  out->mc_att_ctrl_status.roll_rate_integ = NAN;
  out->mc_att_ctrl_status.pitch_rate_integ = NAN;
  out->mc_att_ctrl_status.yaw_rate_integ = NAN;
#elif defined(NAN_AT_STEP)
  if (port->law.step_index == NAN_AT_STEP) out->mc_att_ctrl_status.pitch_rate_integ = NAN;
#endif
  return result;
}

WRAPPER_UNIT("outputs", create, step);
