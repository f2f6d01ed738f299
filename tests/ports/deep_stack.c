/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass; its steps use 64 KiB of stack, which `attest time` reports. */
#include <stddef.h>

#include "wrapper.h"

enum { scratch_bytes = 65536, page_bytes = 4096 };

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  volatile unsigned char scratch[scratch_bytes];
  for (size_t i = 0; i < scratch_bytes; i += page_bytes) scratch[i] = (unsigned char)i;
  return scratch[0] + wrapper_step(self, in, out);
}

WRAPPER_UNIT("deep_stack", wrapper_create, step);
