/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * Judged: pass, each case once. It starts a process that outlives it, and a second one that goes on
 * as if it were the port; neither may answer for it, nor hold up the run, nor be left behind.
 */
#include <unistd.h>

#include "wrapper.h"

static void* create(const char* profile) {
  if (fork() == 0) {
    sleep(60);
    _exit(0);
  }
  return wrapper_create(profile);
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  if (wrapper_fault_is_due(self)) (void)!fork();
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("forks", create, step);
