/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: not loaded. Its mixer has no step. */
#include <stddef.h>
#include <string.h>

#include "attest_actuation.h"

const attest_unit* attest_starter_unit_v1(void);

static void* create(const char* profile, const char* definition) {
  (void)profile;
  (void)definition;
  return NULL;
}

static void destroy(void* self) { (void)self; }

static const void* extension(const char* id) {
  static const attest_mixer mixer = {create, destroy, NULL};
  return strcmp(id, ATTEST_EXTENSION_MIXER) == 0 ? &mixer : NULL;
}

ATTEST_EXPORT const attest_unit* attest_unit_v1(void) {
  static attest_unit table;
  table = *attest_starter_unit_v1();
  table.extension = extension;
  return &table;
}
