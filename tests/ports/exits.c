/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: crash. A process that ends with status 0 before its answer has not passed. */
#include <stdlib.h>

#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  if (wrapper_fault_is_due(self)) exit(0);
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("exits", wrapper_create, step);
