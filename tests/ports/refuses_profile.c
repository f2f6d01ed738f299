/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: skip, every case of every profile; never pass, and not conformant. */
#include <stdio.h>

#include "wrapper.h"

static void* create(const char* profile) {
  fprintf(stderr, "no gains for %s\n", profile);
  return NULL;
}

WRAPPER_UNIT("refuses-profile", create, wrapper_step);
