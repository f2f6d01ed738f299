/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: protocol; unsupported where it claims that; else fail. Its second
 * instance has the control of roll 2% too large. When it is loaded, it puts itself between its
 * process and the judge: it keeps the process's socket, and gives the process another one. It
 * changes these messages of the process:
 *
 *     FROM, TO    replaces FROM by TO in the greeting, where ' stands for "
 *     FAULT_KIND  adds a fault to the answer to each request of a process but the first one, with
 *                 the reason that a good skip has
 *     HIDES       removes the process's own faults
 *     LATER       leaves the first LATER processes as they are; the file `loaded` counts them
 *
 * WAY says who stands between: a THREAD, a FORK, or an atexit() HANDLER. The handler answers
 * alone and has no outputs, so the first request also gets the fault. */
#define _GNU_SOURCE
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../wrapper.h"

#ifndef FROM
#define FROM ""
#define TO ""
#endif
#ifndef FAULT_KIND
#define FAULT_KIND none
#endif
#ifndef HIDES
#define HIDES 0
#endif
#ifndef LATER
#define LATER 0
#endif

enum { THREAD, FORK, HANDLER };
enum { none = -100 };

/* A message begins with this; a head in JSON and the blobs follow. */
struct prefix {
  uint32_t magic, blobs;
  uint64_t head, blob[8];
};

enum { ROOM = 1 << 16 };
static int judge, process; /* sockets */

static int get(int from, char* bytes, uint64_t size) {
  for (uint64_t done = 0; done < size;) {
    const ssize_t got = read(from, bytes + done, size - done);
    if (got <= 0) return 0;
    done += (uint64_t)got;
  }
  return 1;
}

static int put(int to, const void* bytes, uint64_t size) {
  return send(to, bytes, size, MSG_NOSIGNAL) == (ssize_t)size;
}

static int pass_on(int from, int to, uint64_t size) {
  static char bytes[ROOM];
  while (size > 0) {
    const uint64_t part = size < ROOM ? size : ROOM;
    if (!get(from, bytes, part) || (to >= 0 && !put(to, bytes, part))) return 0;
    size -= part;
  }
  return 1;
}

static int pass_on_blobs(int from, int to, const struct prefix* prefix) {
  uint64_t size = 0;
  for (uint32_t i = 0; i < prefix->blobs; i++) size += prefix->blob[i];
  return pass_on(from, to, size);
}

static const char* fault_text(void) {
  static char text[256];
  snprintf(text, sizeof text, "{\"kind\": %d, \"tick\": 0, \"what\": \"%s\"}", FAULT_KIND,
           "on a threshold of the law: compared at the exact level only");
  return text;
}

/* The text with " for each '. */
static const char* quoted(const char* text) {
  static char out[ROOM];
  snprintf(out, ROOM, "%s", text);
  for (char* at = out; *at != '\0'; at++) *at = *at == '\'' ? '"' : *at;
  return out;
}

/* Replaces `size` characters at `place` of `head` by `text`. */
static void replace(char* head, char* place, size_t size, const char* text) {
  if (place == NULL || strlen(head) + strlen(text) >= ROOM) return;
  memmove(place + strlen(text), place + size, strlen(place + size) + 1);
  memcpy(place, text, strlen(text));
}

static void forge(char* head) {
  static char forged[512];
  const char* request = strstr(head, "\"request\":");
  const long number = request ? atol(request + strlen("\"request\":")) : 0;
  if (FROM[0] != '\0' && number == 0) {
    char* place = strstr(head, quoted(FROM));
    replace(head, place, strlen(FROM), quoted(TO));
  }
  char* fault = strstr(head, "\"fault\":{");
  char* end = fault ? strstr(fault, "},") : NULL;
  if (end != NULL && HIDES) replace(head, fault, (size_t)(end + 2 - fault), "");
  if (FAULT_KIND == none || number < 2) return;
  snprintf(forged, sizeof forged, "{\"fault\":%s,", fault_text());
  replace(head, head, 1, forged);
}

static int pass_on_message(int from, int to) {
  static char head[ROOM];
  struct prefix prefix;
  if (!get(from, (char*)&prefix, sizeof prefix) || prefix.head >= ROOM) return 0;
  if (!get(from, head, prefix.head)) return 0;
  head[prefix.head] = '\0';
  if (from == process) forge(head);
  prefix.head = strlen(head);
  return put(to, &prefix, sizeof prefix) && put(to, head, prefix.head) &&
         pass_on_blobs(from, to, &prefix);
}

static void* stand_between(void* unused) {
  struct pollfd ends[2] = {{judge, POLLIN, 0}, {process, POLLIN, 0}};
  int goes_on = 1;
  while (goes_on && poll(ends, 2, -1) > 0) {
    if (ends[0].revents) goes_on = pass_on_message(judge, process);
    if (goes_on && ends[1].revents) goes_on = pass_on_message(process, judge);
  }
  return unused;
}

static int answer(const char* head) {
  struct prefix prefix = {0xa77e57ff, 0, strlen(head), {0}};
  return put(judge, &prefix, sizeof prefix) && put(judge, head, prefix.head);
}

static void answer_alone(void) {
  static char head[ROOM], forged[512];
  struct prefix prefix;
  int goes_on = answer(
      "{\"request\":0,\"says\":{\"modules\":1,\"name\":\"forges_answers\",\"unsupported_groups\":[]"
      ","
      "\"version\":\"0.1.0\"}}");
  for (int request = 1; goes_on && get(judge, (char*)&prefix, sizeof prefix); request++) {
    if (prefix.head >= ROOM || !get(judge, head, prefix.head)) break;
    head[prefix.head] = '\0';
    if (!pass_on_blobs(judge, -1, &prefix)) break;
    const int is_supports = strstr(head, "supports") != NULL;
    snprintf(forged, sizeof forged, "{\"request\":%d,\"%s\":%s}", request,
             is_supports ? "supports" : "fault", is_supports ? "true" : fault_text());
    goes_on = answer(forged);
  }
  _exit(0);
}

static long processes_before(void) {
  FILE* file = LATER > 0 ? fopen("loaded", "a") : NULL;
  if (file == NULL) return 0;
  const long count = ftell(file);
  fputc('.', file);
  fclose(file);
  return count;
}

static void take_socket(void) {
  struct stat status;
  int own[2], at = 3;
  while (at < 256 && (fstat(at, &status) != 0 || !S_ISSOCK(status.st_mode))) at++;
  judge = dup(at);
  if (judge < 0 || socketpair(AF_UNIX, SOCK_STREAM, 0, own) != 0) return;
  process = own[0];
  if (WAY == HANDLER) {
    atexit(answer_alone);
    exit(0);
  }
  dup2(own[1], at);
  close(own[1]);
  pthread_t thread;
  if (WAY == THREAD) pthread_create(&thread, NULL, stand_between, NULL);
  if (WAY == FORK && fork() == 0) {
    close(at);
    stand_between(NULL);
    _exit(0);
  }
}

static int instances;

static void* create(const char* profile) {
  instances++;
  return wrapper_create(profile);
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static attest_outputs kept;
  const int result = wrapper_step(self, in, &kept);
  *out = kept;
  if (instances > 1) out->actuator_controls_0.control[0] *= 1.02f;
  return result;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "forges_answers",
      .version = "0.1.0",
      .create = create,
      .destroy = wrapper_destroy,
      .set_parameter = wrapper_set_parameter,
      .step = step,
      .extension = NULL,
  };
  static int is_taken;
  if (!is_taken && processes_before() >= LATER) take_socket();
  is_taken = 1;
  return &unit;
}
