/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fail, in open loop. Its rate gains of roll and pitch are 3% too low, so that each of its
 * flights is good, and only the distribution of many shows a difference. */
#include <string.h>

#include "wrapper.h"

static const float too_low = 0.97f;

static int set_parameter(void* self, const char* name, float value) {
  const int is_gain = strcmp(name, "MC_ROLLRATE_P") == 0 || strcmp(name, "MC_PITCHRATE_P") == 0;
  return wrapper_set_parameter(self, name, is_gain ? too_low * value : value);
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "gains-off",
      .version = "0.1.0",
      .create = wrapper_create,
      .destroy = wrapper_destroy,
      .set_parameter = set_parameter,
      .step = wrapper_step,
      .extension = NULL,
  };
  return &unit;
}
