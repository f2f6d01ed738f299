/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: never pass. At step 20 its outputs are right, but it writes past them. The host finds its
 * guard bytes changed (protocol), or the process dies (crash). */
#include <string.h>

#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const int due = wrapper_fault_is_due(self);
  const int result = wrapper_step(self, in, out);
  if (due) {
    unsigned char* volatile end = (unsigned char*)(out + 1); /* volatile: see no bounds here */
    memset(end, 0xAB, 64);
  }
  return result;
}

WRAPPER_UNIT("writes-wild", wrapper_create, step);
