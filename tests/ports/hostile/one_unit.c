/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: protocol, from the second case of a process on. create() makes a unit once and then
 * returns NULL, although the port supported the profile when it was asked. */
#include "../wrapper.h"

static void* create(const char* profile) {
  static int calls;
  return calls++ == 0 ? wrapper_create(profile) : NULL;
}

WRAPPER_UNIT("one-unit", create, wrapper_step);
