/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: crash, because its answers cannot arrive. The report must not say that it was killed,
 * because it was the host that killed it. */
#include <unistd.h>

#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  if (wrapper_fault_is_due(self)) {
    for (int descriptor = 3; descriptor < 64; descriptor++) (void)close(descriptor);
    sleep(60);
  }
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("closes_descriptors", wrapper_create, step);
