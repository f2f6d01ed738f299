/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: refused when it is loaded, naming both versions; nothing of it but abi_version may be
 * used. The functions are absent to prove it. */
#include "wrapper.h"

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {.abi_version = 99};
  return &unit;
}
