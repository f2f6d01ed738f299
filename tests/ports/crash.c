/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: crash, with the signal's name; the other cases must still run. */
#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  if (wrapper_fault_is_due(self)) {
    /* Both volatile: gcc 12 drops a plain store through a pointer that it has seen to be null. */
    volatile int* volatile nowhere = NULL;
    *nowhere = 1;
  }
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("crash", wrapper_create, step);
