/* SPDX-License-Identifier: BSD-3-Clause */
/* Declares that MC_YAW_FF is a constant in it, but lets it change. Judged: right, and a note. */
#include <string.h>

#include "wrapper.h"

static const void* extension(const char* id) {
  return strcmp(id, ATTEST_EXTENSION_LACKS) == 0 ? "MC_YAW_FF=0.5" : NULL;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "constant-that-changes",
      .version = "0.1.0",
      .create = wrapper_create,
      .destroy = wrapper_destroy,
      .set_parameter = wrapper_set_parameter,
      .step = wrapper_step,
      .extension = extension,
  };
  return &unit;
}
