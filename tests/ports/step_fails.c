/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fail, at step 20, as the port's own report. The outputs of that step are right: only the
 * result shows the failure. */
#include <stdio.h>

#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const int due = wrapper_fault_is_due(self);
  const int result = wrapper_step(self, in, out);
  if (due) fprintf(stderr, "no solution of the tilt\n");
  return due ? ATTEST_FAILED : result;
}

WRAPPER_UNIT("step-fails", wrapper_create, step);
