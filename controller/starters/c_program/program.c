/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * program.c - makes a program of a port that implements attest_unit.h, for `--port proc:COMMAND`.
 *
 *     cc -std=c11 -O2 -ffp-contract=off -I<folder of attest_unit.h> YOUR_SOURCES program.c -lm
 *
 * It speaks the binary frames of PROTOCOL.md, for the controller only. A port on a board can keep
 * this file on the host, and send the structs to the board in its own functions. With the argument
 * --shared the frames are in memory shared with attest instead of pipes.
 */
#include <poll.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "attest_unit.h"

enum { CREATE = 1, DESTROY, SET_PARAMETER, STEP, BATCH };
enum { MAX_BATCH = 1024, MAX_TEXT = 4096, UNITS_MAX = 64, PROFILE_MAX = 64 };

typedef struct {
  uint32_t size, kind, unit, sequence;
} header;

typedef struct {
  uint64_t timestamp_sample;
  attest_inputs in;
} timed_inputs;

/* The payloads: structs as they are in memory, on a little-endian machine. */
typedef union {
  char text[MAX_TEXT];
  struct {
    uint32_t module, profile_length;
    char profile[MAX_TEXT - 8];
  } create;
  struct {
    float value;
    char name[MAX_TEXT - 4];
  } set_parameter;
  timed_inputs step;
  struct {
    uint32_t steps, zero;
    timed_inputs step[MAX_BATCH];
  } batch;
} request;

typedef struct {
  uint32_t result;
  union {
    attest_outputs out;
    struct {
      uint32_t done;
      attest_outputs out[MAX_BATCH];
    } batch;
  } of;
} answer;

typedef struct {
  void* self; /* NULL if the entry is free */
  uint32_t number;
  attest_outputs out; /* the same struct for every step, as the ABI says */
} instance;

static instance instances[UNITS_MAX];

static instance* find(uint32_t number) {
  for (int i = 0; i < UNITS_MAX; ++i) {
    if (instances[i].self && instances[i].number == number) return &instances[i];
  }
  return NULL;
}

static uint32_t create(const attest_unit* port, uint32_t number, const request* of) {
  char profile[PROFILE_MAX] = {0};
  if (of->create.module != 0 || of->create.profile_length >= PROFILE_MAX) return ATTEST_UNSUPPORTED;
  memcpy(profile, of->create.profile, of->create.profile_length);
  for (int i = 0; i < UNITS_MAX; ++i) {
    if (instances[i].self) continue;
    memset(&instances[i], 0, sizeof instances[i]);
    instances[i].number = number;
    instances[i].self = port->create(profile);
    return instances[i].self ? ATTEST_OK : ATTEST_UNSUPPORTED;
  }
  return ATTEST_UNSUPPORTED;
}

/* Fills `to` and returns the size of its payload. */
static size_t batch(const attest_unit* port, instance* unit, const request* of, answer* to) {
  uint32_t done = 0;
  to->result = ATTEST_OK;
  for (; done < of->batch.steps && done < MAX_BATCH; ++done) {
    to->result = (uint32_t)port->step(unit->self, &of->batch.step[done].in, &unit->out);
    if (to->result != ATTEST_OK) break;
    to->of.batch.out[done] = unit->out;
  }
  to->of.batch.done = done;
  return 2 * sizeof(uint32_t) + done * sizeof(attest_outputs);
}

static size_t serve(const attest_unit* port, const header* head, request* of, answer* to) {
  instance* const unit = find(head->unit);
  if (head->kind == CREATE) {
    to->result = create(port, head->unit, of);
  } else if (!unit) {
    to->result = ATTEST_INVALID;
  } else if (head->kind == SET_PARAMETER) {
    to->result =
        (uint32_t)port->set_parameter(unit->self, of->set_parameter.name, of->set_parameter.value);
  } else if (head->kind == STEP) {
    to->result = (uint32_t)port->step(unit->self, &of->step.in, &unit->out);
    to->of.out = unit->out;
    return sizeof(uint32_t) + sizeof(attest_outputs);
  } else if (head->kind == BATCH) {
    return batch(port, unit, of, to);
  } else {
    port->destroy(unit->self);
    unit->self = NULL;
    to->result = ATTEST_OK;
  }
  return sizeof(uint32_t);
}

/* ---- frames through pipes -------------------------------------------------------------------- */

static int read_frame(header* head, request* of) {
  if (fread(head, sizeof *head, 1, stdin) != 1 || head->size > sizeof *of) return 0;
  return head->size == 0 || fread(of, head->size, 1, stdin) == 1;
}

static void write_frame(const header* head, const answer* to) {
  fwrite(head, sizeof *head, 1, stdout);
  fwrite(to, head->size, 1, stdout);
  fflush(stdout);
}

/* ---- frames in shared memory ----------------------------------------------------------------- */

enum { SHARED_FILE = 3 };
enum { LOOKS_ALONE = 4096, LOOKS_UNTIL_ASKED = 1024 };

typedef struct {
  _Alignas(64) _Atomic uint32_t requests;
  _Alignas(64) _Atomic uint32_t answers;
  _Alignas(4096) unsigned char request[262144];
  unsigned char answer[262144];
} shared_memory;

static shared_memory* shared; /* NULL if frames are in pipes */

static int share_memory(void) {
  void* const at = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, SHARED_FILE, 0);
  if (at == MAP_FAILED) return 0;
  shared = at;
  return 1;
}

/* Waits until attest has written one more request. Returns 0 if attest has closed stdin. */
static int wait_for_request(void) {
  const uint32_t last = atomic_load_explicit(&shared->answers, memory_order_relaxed);
  struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};
  for (unsigned look = 0; atomic_load_explicit(&shared->requests, memory_order_acquire) == last;
       ++look) {
    if (look < LOOKS_ALONE) continue;
    sched_yield(); /* so that attest has a turn if it runs on the same CPU */
    if (look % LOOKS_UNTIL_ASKED == 0 && poll(&in, 1, 0) != 0) return 0;
  }
  return 1;
}

static int take_frame(header* head, request* of) {
  if (!wait_for_request()) return 0;
  memcpy(head, shared->request, sizeof *head);
  if (head->size > sizeof *of) return 0;
  memcpy(of, shared->request + sizeof *head, head->size);
  return 1;
}

static void put_frame(const header* head, const answer* to) {
  memcpy(shared->answer, head, sizeof *head);
  memcpy(shared->answer + sizeof *head, to, head->size);
  atomic_fetch_add_explicit(&shared->answers, 1, memory_order_release);
}

int main(int count, char** arguments) {
  static char line[65536];
  static request of;
  static answer to;
  const attest_unit* const port = attest_unit_v1();
  const int is_shared = count > 1 && strcmp(arguments[1], "--shared") == 0;
  header head;
  if (!fgets(line, sizeof line, stdin)) return EXIT_FAILURE;
  if (is_shared && !share_memory()) return EXIT_FAILURE;
  printf(
      "{\"protocol\":1,\"name\":\"%s\",\"version\":\"%s\",\"frames\":\"%s\",\"batch\":true,"
      "\"profiles\":[\"px4-v1.5.5\",\"px4-v1.3.4\"]}\n",
      port->name, port->version, is_shared ? "shared" : "binary");
  fflush(stdout);
  while (shared ? take_frame(&head, &of) : read_frame(&head, &of)) {
    if (head.size < MAX_TEXT) of.text[head.size] = '\0'; /* terminates the name of a parameter */
    head.size = (uint32_t)serve(port, &head, &of, &to);
    if (shared) {
      put_frame(&head, &to);
    } else {
      write_frame(&head, &to);
    }
  }
  return EXIT_SUCCESS;
}
