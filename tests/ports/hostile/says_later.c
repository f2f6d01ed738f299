/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: protocol. The extension EXTENSION is FIRST until create() was called, and LATER
 * afterwards. */
#include <stddef.h>
#include <string.h>

#include "../wrapper.h"

static int was_created;

static void* create(const char* profile) {
  was_created = 1;
  return wrapper_create(profile);
}

static const void* extension(const char* id) {
  if (strcmp(id, EXTENSION) != 0) return NULL;
  return was_created ? LATER : FIRST;
}

ATTEST_EXPORT const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "says-later",
      .version = "0.1.0",
      .create = create,
      .destroy = wrapper_destroy,
      .set_parameter = wrapper_set_parameter,
      .step = wrapper_step,
      .extension = extension,
  };
  return &unit;
}
