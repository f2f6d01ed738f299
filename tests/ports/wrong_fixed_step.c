/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: not loaded. Its fixed step is not a rate. */
#include <stddef.h>
#include <string.h>

#include "attest_unit.h"

const attest_unit* attest_starter_unit_v1(void);

static const void* extension(const char* id) {
  return strcmp(id, ATTEST_EXTENSION_FIXED_STEP) == 0 ? "4 ms" : NULL;
}

ATTEST_EXPORT const attest_unit* attest_unit_v1(void) {
  static attest_unit table;
  table = *attest_starter_unit_v1();
  table.extension = extension;
  return &table;
}
