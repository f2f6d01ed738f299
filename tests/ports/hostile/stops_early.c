/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged in real time: protocol. Asks its own process to stop at step 20, before it goes wrong. */
#include <signal.h>

#include "../wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static attest_outputs kept;
  if (wrapper_fault_is_due(self)) raise(SIGTERM);
  const wrapper* w = self;
  const int is_wrong = w->step_index > WRAPPER_FAULT_STEP;
  const int result = wrapper_step(self, in, &kept);
  *out = kept;
  if (is_wrong) out->actuator_controls_0.control[0] += 0.1f;
  return result;
}

WRAPPER_UNIT("stops_early", wrapper_create, step);
