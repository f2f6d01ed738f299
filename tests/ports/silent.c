/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fail at the first step in which the golden publishes. Its zeros must not pass as small
 * values: the publication flags differ. */
#include <string.h>

#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  attest_outputs unseen;
  memset(&unseen, 0, sizeof unseen);
  (void)out;
  return wrapper_step(self, in, &unseen);
}

WRAPPER_UNIT("silent", wrapper_create, step);
