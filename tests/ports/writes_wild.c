/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: never pass. At step 20 it writes past the outputs, with outputs that are right: the host
 * finds its guard bytes changed (protocol), or its process dies of it (crash). */
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
