/* SPDX-License-Identifier: BSD-3-Clause */
/* Never publishes mc_att_ctrl_status, and does not declare that. Judged: one vector fails for it.
 */
#include <string.h>

#include "wrapper.h"

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const int result = wrapper_step(self, in, out);
  memset(&out->mc_att_ctrl_status, 0, sizeof out->mc_att_ctrl_status);
  return result;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "silent-topic",
      .version = "0.1.0",
      .create = wrapper_create,
      .destroy = wrapper_destroy,
      .set_parameter = wrapper_set_parameter,
      .step = step,
      .extension = NULL,
  };
  return &unit;
}
