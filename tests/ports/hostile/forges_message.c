/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: protocol. Has the torque's sign wrong. At its first step it writes the file that
 * FORGED_MESSAGE names, a whole message of attest, into every open descriptor. */
#include <stdio.h>
#include <unistd.h>

#include "../wrapper.h"

static void forge(void) {
  static char message[1 << 16];
  FILE* file = fopen(getenv("FORGED_MESSAGE"), "rb");
  if (!file) return;
  const size_t size = fread(message, 1, sizeof message, file);
  fclose(file);
  for (int descriptor = 3; descriptor < 256; descriptor++) {
    if (write(descriptor, message, size) < 0) continue;
  }
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static attest_outputs kept;
  static int has_forged;
  const int result = wrapper_step(self, in, &kept);
  if (!has_forged) forge();
  has_forged = 1;
  *out = kept;
  for (int i = 0; i < 3; i++) out->actuator_controls_0.control[i] *= -1.0f;
  return result;
}

WRAPPER_UNIT("forges_message", wrapper_create, step);
