/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged in real time: protocol. Asks its own process to stop at step 20, before it goes wrong: it
 * sets all bytes of the memory that the process shares with its judge. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "../wrapper.h"

static void ask_to_stop(void) {
  FILE* const maps = fopen("/proc/self/maps", "r");
  char line[4096];
  while (maps && fgets(line, sizeof line, maps)) {
    uintptr_t begin = 0, end = 0;
    char rights[5];
    const int read = sscanf(line, "%lx-%lx %4s", &begin, &end, rights); /* NOLINT */
    const int is_shared = read == 3 && strcmp(rights, "rw-s") == 0;
    if (is_shared) memset((void*)begin, 1, end - begin); /* NOLINT */
  }
  if (maps) fclose(maps);
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static attest_outputs kept;
  if (wrapper_fault_is_due(self)) ask_to_stop();
  const wrapper* w = self;
  const int is_wrong = w->step_index > WRAPPER_FAULT_STEP;
  const int result = wrapper_step(self, in, &kept);
  *out = kept;
  if (is_wrong) out->actuator_controls_0.control[0] += 0.1f;
  return result;
}

WRAPPER_UNIT("stops_early", wrapper_create, step);
