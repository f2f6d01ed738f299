/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass, and the cases of the rate unit of px4-v1.16.0 are unsupported. It has the attitude
 * unit of all profiles, and the rate unit of the older ones. */
#include <attest_cascade.h>
#include <stddef.h>
#include <string.h>

const attest_unit* attest_starter_unit_v1(void);

static const attest_rate_unit* right(void) {
  return attest_starter_unit_v1()->extension(ATTEST_EXTENSION_RATE_UNIT);
}

static void* create(const char* profile) {
  return strcmp(profile, "px4-v1.16.0") == 0 ? NULL : right()->create(profile);
}

static const void* extension(const char* id) {
  static attest_rate_unit rate;
  if (strcmp(id, ATTEST_EXTENSION_RATE_UNIT) != 0) return attest_starter_unit_v1()->extension(id);
  rate = *right();
  rate.create = create;
  return &rate;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "other-profiles",
      .version = "0.1.0",
      .extension = extension,
  };
  return &unit;
}
