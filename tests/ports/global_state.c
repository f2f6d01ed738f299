/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass. Its one instance lives in file scope, as in much generated code. The host must not
 * create two at a time in a process, and must create a new one for every case. */
#include "wrapper.h"

static wrapper* the_instance;

static void destroy(void* self) {
  (void)self;
  if (the_instance == NULL) return;
  wrapper_destroy(the_instance);
  the_instance = NULL;
}

static void* create(const char* profile) {
  destroy(NULL);
  the_instance = wrapper_create(profile);
  return the_instance;
}

static int set_parameter(void* self, const char* name, float value) {
  (void)self;
  return wrapper_set_parameter(the_instance, name, value);
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  (void)self;
  return wrapper_step(the_instance, in, out);
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "global-state",
      .version = "0.1.0",
      .create = create,
      .destroy = destroy,
      .set_parameter = set_parameter,
      .step = step,
      .extension = NULL,
  };
  return &unit;
}
