/* SPDX-License-Identifier: BSD-3-Clause */
/* A program on the machine of attest: frames in pipes or, with the argument --shared, in memory. */
#include <poll.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "program.h"

/* ---- shared memory ---------------------------------------------------------------------------*/

enum { SHARED_FILE = 3 };
enum { LOOKS_ALONE = 4096, LOOKS_UNTIL_ASKED = 1024 };

typedef struct {
  _Alignas(64) _Atomic uint32_t requests;
  _Alignas(64) _Atomic uint32_t answers;
  _Alignas(4096) unsigned char request[262144];
  unsigned char answer[262144];
} shared_memory;

static shared_memory* shared; /* NULL if frames are in pipes */
static size_t taken;          /* bytes of the request that were read */

static shared_memory* share_memory(void) {
  void* const at = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, SHARED_FILE, 0);
  return at == MAP_FAILED ? NULL : at;
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

static int take(void* to, size_t size) {
  if (taken == 0 && !wait_for_request()) return 0;
  if (size > sizeof shared->request - taken) return 0;
  memcpy(to, shared->request + taken, size);
  taken += size;
  return 1;
}

static void give(const void* from, size_t size) {
  memcpy(shared->answer, from, size);
  taken = 0;
  atomic_fetch_add_explicit(&shared->answers, 1, memory_order_release);
}

/* ---- the connection --------------------------------------------------------------------------*/

int connection_read(void* to, size_t size) {
  if (shared) return take(to, size);
  return size == 0 || fread(to, size, 1, stdin) == 1;
}

void connection_write(const void* from, size_t size) {
  if (shared) {
    give(from, size);
  } else {
    fwrite(from, size, 1, stdout);
    fflush(stdout);
  }
}

int main(int count, char** arguments) {
  const int is_shared = count > 1 && strcmp(arguments[1], "--shared") == 0;
  shared_memory* const memory = is_shared ? share_memory() : NULL;
  if (is_shared && !memory) return EXIT_FAILURE;
  if (!program_greet(is_shared ? "shared" : "binary")) return EXIT_FAILURE;
  shared = memory; /* the handshake is in pipes */
  program_serve();
  return EXIT_SUCCESS;
}
