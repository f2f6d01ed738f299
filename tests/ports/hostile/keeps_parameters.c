/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fail in the group instances. Its parameters live outside the instance: a new instance has
 * those of the one before. */
#include <string.h>

#include "../wrapper.h"

static struct {
  char name[32];
  float value;
} kept[64];
static size_t count;

static int set_parameter(void* self, const char* name, float value) {
  const int result = wrapper_set_parameter(self, name, value);
  if (result == ATTEST_OK && count < sizeof kept / sizeof kept[0] && strlen(name) < 32) {
    strcpy(kept[count].name, name);
    kept[count++].value = value;
  }
  return result;
}

static void* create(const char* profile) {
  void* const self = wrapper_create(profile);
  if (self == NULL) return NULL;
  for (size_t i = 0; i < count; i++) {
    wrapper_set_parameter(self, kept[i].name, kept[i].value);
  }
  return self;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "keeps-parameters",
      .version = "0.1.0",
      .create = create,
      .destroy = wrapper_destroy,
      .set_parameter = set_parameter,
      .step = wrapper_step,
      .extension = NULL,
  };
  return &unit;
}
