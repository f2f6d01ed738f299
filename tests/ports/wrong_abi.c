/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: refused when it is loaded, naming both versions. The host may read only abi_version: the
 * functions are absent, so any call would crash. */
#include "wrapper.h"

#ifndef ABI_VERSION
#define ABI_VERSION 99
#endif

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {.abi_version = ABI_VERSION};
  return &unit;
}
