/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fail, in every case that pitches. It takes a nose-down pitch rate as positive, the most
 * common mistake between frames. */
#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  attest_inputs flipped = *in;
  flipped.control_state.pitch_rate = -in->control_state.pitch_rate;
  return wrapper_step(self, &flipped, out);
}

WRAPPER_UNIT("sign-flip", wrapper_create, step);
