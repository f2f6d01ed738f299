/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass, if the host restores its floating-point mode after loading. The constructor sets
 * flush-to-zero and denormals-are-zero, as any library linked with -ffast-math does. If the mode
 * stayed set, the results of the host and of later ports would change. On a processor without SSE
 * this is just a right port. */
#include "wrapper.h"

#if defined(__SSE2__)
#include <xmmintrin.h>

#define MXCSR_FTZ 0x8000u
#define MXCSR_DAZ 0x0040u

__attribute__((constructor)) static void set_ftz(void) {
  _mm_setcsr(_mm_getcsr() | MXCSR_FTZ | MXCSR_DAZ);
}
#endif

WRAPPER_UNIT("sets-ftz", wrapper_create, wrapper_step);
