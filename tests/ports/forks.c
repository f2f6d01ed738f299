/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * Judged: pass, each case once. It starts a process that outlives it, and a second one that
 * continues as if it were the port. Neither may answer for the port, delay the run, or outlive the
 * run.
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
