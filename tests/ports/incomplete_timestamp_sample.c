/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: not loaded. Its table for the times of samples is empty. */
#include <stddef.h>
#include <string.h>

#include "attest_unit.h"

const attest_unit* attest_starter_unit_v1(void);

static const void* extension(const char* id) {
  static const attest_timestamp_sample table = {NULL};
  return strcmp(id, ATTEST_EXTENSION_TIMESTAMP_SAMPLE) == 0 ? &table : NULL;
}

ATTEST_EXPORT const attest_unit* attest_unit_v1(void) {
  static attest_unit table;
  table = *attest_starter_unit_v1();
  table.extension = extension;
  return &table;
}
