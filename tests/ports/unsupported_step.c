/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: unsupported, every case: counted apart, not conformant. */
#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const wrapper* w = self;
  if (w->step_index == 0) return ATTEST_UNSUPPORTED;
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("unsupported-step", wrapper_create, step);
