/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fail. Ports that look for the golden in the memory of their process: a sample with the
 * inputs of this step, followed by outputs.
 *
 *     copies_golden      has no law, and returns the outputs that it finds
 *     rewrites_golden    has the torque's sign wrong, and overwrites what it finds with its outputs
 *
 * Both passed while the judge ran in the same process; with --in-process they still pass. */
#include <stdio.h>
#include <string.h>

#include "../wrapper.h"

/* The layout in which attest stores a tick: the inputs, then the outputs. */
typedef struct sample {
  attest_inputs in;
  attest_outputs out;
} sample;

static int is_golden(const sample* found, const attest_inputs* in, const void* self) {
  static const attest_outputs none;
  return &found->in != in && (const void*)found != self &&
         memcmp(&found->in, in, sizeof *in) == 0 && memcmp(&found->out, &none, sizeof none) != 0;
}

static void visit(sample* found, const attest_outputs* mine, attest_outputs* out) {
#ifdef REWRITES
  (void)out;
  found->out = *mine;
#else
  (void)mine;
  *out = found->out;
#endif
}

/* Searches all memory that the process may write, except the step's own `in`. */
static void search(const attest_inputs* in, const attest_outputs* mine, const void* self,
                   attest_outputs* out) {
  FILE* maps = fopen("/proc/self/maps", "r");
  char line[512];
  while (maps && fgets(line, sizeof line, maps)) {
    unsigned long begin, end;
    char rights[5];
    if (sscanf(line, "%lx-%lx %4s", &begin, &end, rights) != 3) continue;
    if (rights[0] != 'r' || rights[1] != 'w' || strstr(line, "[v")) continue;
    for (unsigned long at = begin; at + sizeof(sample) <= end; at += 8) {
      sample* const found = (sample*)at;
      if (found->in.timestamp == in->timestamp && is_golden(found, in, self)) {
        visit(found, mine, out);
      }
    }
  }
  if (maps) fclose(maps);
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  attest_outputs mine;
  memset(&mine, 0, sizeof mine);
#ifdef REWRITES
  /* A step updates `out`, which the host keeps from step to step. */
  static attest_outputs kept;
  const int result = wrapper_step(self, in, &kept);
  if (result != ATTEST_OK) return result;
  mine = kept;
  for (int i = 0; i < 3; i++) mine.actuator_controls_0.control[i] *= -1.0f;
  *out = mine;
#endif
  search(in, &mine, self, out);
  return ATTEST_OK;
}

WRAPPER_UNIT("memory", wrapper_create, step);
