/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass at 250 Hz, and unsupported at other rates and where ticks are late or missing. It
 * always steps by 4 ms and ignores the timestamps, like code that Simulink generates. With GAIN
 * defined it multiplies the roll control by GAIN, and must fail. */
#include <stddef.h>
#include <string.h>

#include "wrapper.h"

static const uint64_t period_us = 4000;

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const wrapper* w = self;
  attest_inputs own = *in;
  own.timestamp = (w->step_index + 1) * period_us;
  const int result = wrapper_step(self, &own, out);
#ifdef GAIN
  if (out->actuator_controls_0.published) out->actuator_controls_0.control[0] *= GAIN;
#endif
  return result;
}

static const void* extension(const char* id) {
  return strcmp(id, ATTEST_EXTENSION_FIXED_STEP) == 0 ? "250" : NULL;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "fixed-step",
      .version = "0.1.0",
      .create = wrapper_create,
      .destroy = wrapper_destroy,
      .set_parameter = wrapper_set_parameter,
      .step = step,
      .extension = extension,
  };
  return &unit;
}
