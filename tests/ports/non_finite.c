/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: non-finite (where the reference has a number), naming control[1] and step 20. */
#include <math.h>

#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const int due = wrapper_fault_is_due(self);
  const int result = wrapper_step(self, in, out);
  if (due) out->actuator_controls_0.control[1] = NAN;
  return result;
}

WRAPPER_UNIT("non-finite", wrapper_create, step);
