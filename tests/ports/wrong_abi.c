/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: refused when it is loaded, naming both versions; nothing of it but abi_version may be
 * used. The functions are absent to prove it. */
#include "wrapper.h"

#ifndef ABI_VERSION
#define ABI_VERSION 99
#endif

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {.abi_version = ABI_VERSION};
  return &unit;
}
