/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass if the estimator's delay is that of the environment variable SAMPLE_DELAY_US (0 if
 * it is not set), fail otherwise. It checks the times of its samples to the microsecond, and that
 * exactly one comes before each step. */
#include <stddef.h>
#include <string.h>

#include "wrapper.h"

static struct {
  uint64_t delay, begin, timestamp_sample;
  int given, started;
} times;

static void* create(const char* profile) {
  const char* delay = getenv("SAMPLE_DELAY_US");
  memset(&times, 0, sizeof times);
  times.delay = delay == NULL ? 0 : strtoull(delay, NULL, 10);
  return wrapper_create(profile);
}

static int set_timestamp_sample(void* self, uint64_t timestamp_sample) {
  (void)self;
  times.timestamp_sample = timestamp_sample;
  return times.given++ == 0 ? ATTEST_OK : ATTEST_FAILED;
}

/* Before the first sample has arrived the unit sees the initial state. */
static uint64_t expected(uint64_t timestamp) {
  return timestamp - times.begin < times.delay ? times.begin : timestamp - times.delay;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  if (!times.started) times.begin = in->timestamp;
  times.started = 1;
  if (times.given != 1 || times.timestamp_sample != expected(in->timestamp)) return ATTEST_FAILED;
  times.given = 0;
  return wrapper_step(self, in, out);
}

static const void* extension(const char* id) {
  static const attest_timestamp_sample table = {set_timestamp_sample};
  return strcmp(id, ATTEST_EXTENSION_TIMESTAMP_SAMPLE) == 0 ? &table : NULL;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "timestamp-sample",
      .version = "0.1.0",
      .create = create,
      .destroy = wrapper_destroy,
      .set_parameter = wrapper_set_parameter,
      .step = step,
      .extension = extension,
  };
  return &unit;
}
