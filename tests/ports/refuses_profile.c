/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: skip, every case of every profile; never pass, and not conformant. */
#include "wrapper.h"

static void* create(const char* profile) {
  (void)profile;
  return NULL;
}

WRAPPER_UNIT("refuses-profile", create, wrapper_step);
