/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass. A thread stops the guard of the worker that judges the port, and the worker, again
 * and again, also in the middle of a message. The outputs are right, so attest must not wait for
 * the stopped processes. */
#define _GNU_SOURCE
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

#include "../wrapper.h"

static pid_t parent_of(pid_t process) {
  char path[64];
  int parent = 0;
  snprintf(path, sizeof path, "/proc/%d/stat", (int)process);
  FILE* file = fopen(path, "r");
  if (file == NULL) return 0;
  if (fscanf(file, "%*d %*s %*c %d", &parent) != 1) parent = 0;
  fclose(file);
  return parent;
}

static void* keep_stopping(void* worker_of_port) {
  const pid_t worker = *(const pid_t*)worker_of_port, guard = parent_of(worker);
  for (;;) {
    if (guard > 1) kill(guard, SIGSTOP);
    if (worker > 1) kill(worker, SIGSTOP);
    usleep(20 * 1000);
  }
  return NULL;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static pid_t worker;
  if (worker == 0) {
    pthread_t thread;
    worker = getppid();
    pthread_create(&thread, NULL, keep_stopping, &worker);
  }
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("stops_judge", wrapper_create, step);
