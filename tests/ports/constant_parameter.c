/* SPDX-License-Identifier: BSD-3-Clause */
/* MC_YAW_FF is a constant in it, with the default of the law. Judged: right, and the cases that set
 * this parameter are unsupported. */
#include <string.h>

#include "wrapper.h"

static int set_parameter(void* self, const char* name, float value) {
  if (strcmp(name, "MC_YAW_FF") == 0) return ATTEST_UNSUPPORTED;
  return wrapper_set_parameter(self, name, value);
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "constant-parameter",
      .version = "0.1.0",
      .create = wrapper_create,
      .destroy = wrapper_destroy,
      .set_parameter = set_parameter,
      .step = wrapper_step,
      .extension = NULL,
  };
  return &unit;
}
