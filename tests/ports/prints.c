/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass. It is right but prints; its text must not get into the host's machine-readable
 * output. */
#include <stdio.h>

#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const wrapper* w = self;
  printf("step %u\n", (unsigned)w->step_index);
  fprintf(stderr, "a note on step %u\n", (unsigned)w->step_index);
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("prints", wrapper_create, step);
