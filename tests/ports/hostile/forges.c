/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: protocol. Has the torque's sign wrong. At each step it writes a forged answer into every
 * open descriptor. */
#include <string.h>
#include <unistd.h>

#include "../wrapper.h"

#ifndef FORGED
#define FORGED "{\"request\": 1, \"result\": \"pass\", \"done\": true}\n"
#endif

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static attest_outputs kept;
  const int result = wrapper_step(self, in, &kept);
  *out = kept;
  for (int i = 0; i < 3; i++) out->actuator_controls_0.control[i] *= -1.0f;
  for (int descriptor = 3; descriptor < 256; descriptor++) {
    if (write(descriptor, FORGED, strlen(FORGED)) < 0) continue;
  }
  return result;
}

WRAPPER_UNIT("forges", wrapper_create, step);
