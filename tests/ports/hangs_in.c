/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * hangs_in.c - never returns from one of its functions, HANGS_IN: create, set_parameter, destroy
 * or load. Judged: timeout; the port's process must be gone afterwards.
 */
#include "wrapper.h"

enum { load, create, set_parameter, destroy };

/* Not a constant for the compiler: a loop without side effects may be assumed to end. */
static volatile int forever = 1;

static void hang_in(int function) {
  while (function == HANGS_IN && forever) {
  }
}

/* While dlopen() runs. */
__attribute__((constructor)) static void on_load(void) { hang_in(load); }

static void* create_or_hang(const char* profile) {
  hang_in(create);
  return wrapper_create(profile);
}

static int set_parameter_or_hang(void* self, const char* name, float value) {
  hang_in(set_parameter);
  return wrapper_set_parameter(self, name, value);
}

static void destroy_or_hang(void* self) {
  hang_in(destroy);
  wrapper_destroy(self);
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "hangs_in",
      .version = "0.1.0",
      .create = create_or_hang,
      .destroy = destroy_or_hang,
      .set_parameter = set_parameter_or_hang,
      .step = wrapper_step,
      .extension = NULL,
  };
  return &unit;
}
