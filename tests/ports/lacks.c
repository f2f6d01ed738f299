/* SPDX-License-Identifier: BSD-3-Clause */
/* Lacks what it declares: the topic of the integrals, the battery scale, and another value of
 * MC_YAW_FF than 0.25, which is not the default. It also declares that it lacks tpa, which it has.
 * Judged: right in what it has. */
#include <string.h>

#include "wrapper.h"

static void* create(const char* profile) {
  void* self = wrapper_create(profile);
  if (self != NULL) wrapper_set_parameter(self, "MC_YAW_FF", 0.25f);
  return self;
}

static int set_parameter(void* self, const char* name, float value) {
  if (strcmp(name, "MC_YAW_FF") == 0) return ATTEST_INVALID;
  return wrapper_set_parameter(self, name, value);
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  attest_inputs without = *in;
  without.battery_status.scale = 1;
  const int result = wrapper_step(self, &without, out);
  memset(&out->mc_att_ctrl_status, 0, sizeof out->mc_att_ctrl_status);
  return result;
}

static const void* extension(const char* id) {
  if (strcmp(id, ATTEST_EXTENSION_LACKS) == 0) {
    return "mc_att_ctrl_status, battery, tpa, MC_YAW_FF=0.25";
  }
  return NULL;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "lacks",
      .version = "0.1.0",
      .create = create,
      .destroy = wrapper_destroy,
      .set_parameter = set_parameter,
      .step = step,
      .extension = extension,
  };
  return &unit;
}
