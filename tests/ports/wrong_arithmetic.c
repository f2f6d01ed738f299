/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: not loaded. It declares decimal arithmetic, for which no tolerance is defined. */
#include <stddef.h>
#include <string.h>

#include "attest_unit.h"

const attest_unit* attest_starter_unit_v1(void);

static const void* extension(const char* id) {
  return strcmp(id, ATTEST_EXTENSION_ARITHMETIC) == 0 ? "decimal" : NULL;
}

ATTEST_EXPORT const attest_unit* attest_unit_v1(void) {
  static attest_unit table;
  table = *attest_starter_unit_v1();
  table.extension = extension;
  return &table;
}
