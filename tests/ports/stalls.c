/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * stalls.c - right, but every 1,000th step keeps the CPU for 300 us, as if it flushed a log or
 * rebuilt a cache. Comparing outputs cannot detect it; a run in real time names the ticks.
 */
#include <time.h>

#include "wrapper.h"

enum { stall_every = 1000, stall_ns = 300000 };

static int64_t now_ns(void) {
  struct timespec now;
  timespec_get(&now, TIME_UTC);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const wrapper* w = self;
  if (w->step_index % stall_every == stall_every - 1) {
    const int64_t begin = now_ns();
    while (now_ns() - begin < stall_ns) {
    }
  }
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("stalls", wrapper_create, step);
