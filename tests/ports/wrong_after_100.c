/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fails. It declares 22 fraction bits, for which tolerances are wide, and is right for 100
   steps; then its yaw control is 4% too large. */
#include <stddef.h>
#include <string.h>

#include "attest_unit.h"

const attest_unit* attest_starter_unit_v1(void);

static int steps;

static const void* extension(const char* id) {
  return strcmp(id, ATTEST_EXTENSION_ARITHMETIC) == 0 ? "fixed:22" : NULL;
}

static void* create(const char* profile) {
  steps = 0;
  return attest_starter_unit_v1()->create(profile);
}

static int step(void* unit, const attest_inputs* in, attest_outputs* out) {
  const int status = attest_starter_unit_v1()->step(unit, in, out);
  if (++steps > 100) out->actuator_controls_0.control[2] *= 1.04f;
  return status;
}

ATTEST_EXPORT const attest_unit* attest_unit_v1(void) {
  static attest_unit table;
  table = *attest_starter_unit_v1();
  table.extension = extension;
  table.create = create;
  table.step = step;
  return &table;
}
