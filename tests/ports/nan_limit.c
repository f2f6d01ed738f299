/* SPDX-License-Identifier: BSD-3-Clause */
/* Does what ON_NAN says while MC_ROLLRATE_MAX is not finite, which is so only in a case that is
 * compared at the level exact. Judged at each level: ABORTS crash; FAILS fail, as the port's own
 * report; REFUSES right except at the level exact, because a port need not allow each value. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "wrapper.h"

enum { ABORTS, FAILS, REFUSES };

static float limit = 220;

static int set_parameter(void* self, const char* name, float value) {
  if (strcmp(name, "MC_ROLLRATE_MAX") == 0) {
    if (ON_NAN == REFUSES && !isfinite(value)) return ATTEST_INVALID;
    limit = value;
  }
  return wrapper_set_parameter(self, name, value);
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  if (!isfinite(limit)) {
    fprintf(stderr, "limit out of range\n");
    if (ON_NAN == ABORTS) abort();
    return ATTEST_FAILED;
  }
  return wrapper_step(self, in, out);
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "nan-limit",
      .version = "0.1.0",
      .create = wrapper_create,
      .destroy = wrapper_destroy,
      .set_parameter = set_parameter,
      .step = step,
      .extension = NULL,
  };
  return &unit;
}
