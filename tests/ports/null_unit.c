/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: refused when it is loaded, as a port that has no unit. */
#include "wrapper.h"

const attest_unit* attest_unit_v1(void) { return NULL; }
