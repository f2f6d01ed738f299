/* SPDX-License-Identifier: BSD-3-Clause */
/* board.h - what the sources of a board need of each other. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Sets memory up and calls main(). Of start.c; the processor's source calls it at reset. */
__attribute__((noinline)) void board_start(void);

/* Reports a fault of the instruction at `pc` and stops. Of start.c. */
_Noreturn void board_fault(uint32_t pc);

/* Reports a fault and stops. Of the connection. */
_Noreturn void board_fail(const char* reason);

#endif /* BOARD_H */
