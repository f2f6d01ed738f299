/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: timeout; the port's process must be gone afterwards. */
#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  if (wrapper_fault_is_due(self)) {
    volatile int forever = 1; /* a loop without side effects may be assumed to end */
    while (forever) {
    }
  }
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("hang", wrapper_create, step);
