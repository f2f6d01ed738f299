/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass; timeout if the variable DAEMON_PORT_WAITS is set. Starts a daemon: a process in a
 * session of its own, whose parent has ended, and which ignores all signals that it can. It must
 * not outlive attest, however attest ends. The daemon has the name `port_daemon`. */
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../wrapper.h"

static void become_daemon(void) {
  if (setsid() < 0 || fork() != 0) _exit(0);
  for (int number = 1; number <= SIGRTMAX; number++) signal(number, SIG_IGN);
  prctl(PR_SET_PDEATHSIG, 0);
  prctl(PR_SET_NAME, "port_daemon");
  for (;;) sleep(60);
}

static void* create(const char* profile) {
  const pid_t parent = fork();
  if (parent == 0) become_daemon();
  waitpid(parent, NULL, 0);
  return wrapper_create(profile);
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  while (getenv("DAEMON_PORT_WAITS") != NULL) sleep(60);
  return wrapper_step(self, in, out);
}

WRAPPER_UNIT("daemon", create, step);
