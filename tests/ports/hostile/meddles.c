/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: never pass. Files are replaced during the run, by the port or by the test:
 *
 *     waits               the first instance is right. Its process has the name `in_step` and waits
 *                         in its first step until the file $MEDDLE_GO exists, so that the test can
 *                         replace files. Later instances have the negated torque.
 *     meddles_in_create   the negated torque. create() replaces each file TO by FROM of
 *                         $MEDDLE_WITH, a list `FROM=TO:FROM=TO`
 *     meddles_in_thread   the same by a thread, again and again
 *     meddles_by_rename   the same in create(), but renames a copy of FROM to TO
 *     replaces_...        the same three, but their outputs are right
 *     pipes, links        create() replaces each TO by a pipe, or by a link to FROM. Their outputs
 *                         are right, those of wrong_links are wrong
 */
#define _GNU_SOURCE
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../wrapper.h"

typedef struct changed {
  wrapper law;
  attest_outputs out;
  int is_wrong;
} changed;

#if defined(WAITS)

static int may_go(void) {
  const char* const go = getenv("MEDDLE_GO");
  return go == NULL || access(go, F_OK) == 0;
}

static void meddle(changed* port) { port->is_wrong = may_go(); }

static void before_first_step(void) {
  prctl(PR_SET_NAME, "in_step");
  while (!may_go()) usleep(10 * 1000);
}

#else

#if defined(PIPES)

static void replace(const char* from, const char* to) {
  (void)from;
  unlink(to);
  mkfifo(to, 0600);
}

#elif defined(LINKS)

static void replace(const char* from, const char* to) {
  unlink(to);
  if (symlink(from, to) != 0) return;
}

#else

static void copy(const char* from, const char* to) {
  static char bytes[1 << 20];
  FILE* file = fopen(from, "rb");
  if (file == NULL) return;
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  file = fopen(to, "wb");
  if (file == NULL) return;
  fwrite(bytes, 1, size, file);
  fclose(file);
}

static void replace(const char* from, const char* to) {
#if defined(RENAMES)
  char written[4096];
  snprintf(written, sizeof written, "%s.new", to);
  copy(from, written);
  rename(written, to);
#else
  copy(from, to);
#endif
}

#endif

static void* replace_all(void* unused) {
  const char* const with = getenv("MEDDLE_WITH");
  char* const list = with == NULL ? NULL : strdup(with);
  char* rest = list;
  for (char* from = NULL; rest != NULL && (from = strsep(&rest, ":")) != NULL;) {
    char* const to = strchr(from, '=');
    if (to == NULL) continue;
    *to = '\0';
    replace(from, to + 1);
  }
  free(list);
  return unused;
}

#if defined(IN_THREAD)
static void* keep_replacing(void* unused) {
  for (;;) {
    replace_all(NULL);
    usleep(1000);
  }
  return unused;
}
#endif

static void meddle(changed* port) {
#if defined(RIGHT)
  port->is_wrong = 0;
#else
  port->is_wrong = 1;
#endif
#if defined(IN_THREAD)
  pthread_t thread;
  pthread_create(&thread, NULL, keep_replacing, NULL);
  usleep(20 * 1000); /* the thread replaces the files once */
#else
  replace_all(NULL);
#endif
}

static void before_first_step(void) {}

#endif

static void* create(const char* profile) {
  wrapper* const law = wrapper_create(profile);
  if (law == NULL) return NULL;
  changed* const port = calloc(1, sizeof *port);
  if (port != NULL) {
    port->law = *law;
    meddle(port);
  }
  free(law);
  return port;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  changed* const port = self;
  if (port->law.step_index == 0) before_first_step();
  const int result = wrapper_step(&port->law, in, &port->out);
  *out = port->out;
  for (int i = 0; port->is_wrong && i < 3; i++) out->actuator_controls_0.control[i] *= -1.0f;
  return result;
}

WRAPPER_UNIT("meddles", create, step);
