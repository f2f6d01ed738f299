/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: crash where a case sets MC_ROLLRATE_FF, skip where it is px4-v1.3.4, pass elsewhere. */
#include <string.h>

#include "wrapper.h"

static void* create(const char* profile) {
  return strcmp(profile, "px4-v1.5.5") == 0 ? wrapper_create(profile) : NULL;
}

static int set_parameter(void* self, const char* name, float value) {
  if (strcmp(name, "MC_ROLLRATE_FF") == 0) abort();
  return wrapper_set_parameter(self, name, value);
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "crashes_on_ff",
      .version = "0.1.0",
      .create = create,
      .destroy = wrapper_destroy,
      .set_parameter = set_parameter,
      .step = wrapper_step,
      .extension = NULL,
  };
  return &unit;
}
