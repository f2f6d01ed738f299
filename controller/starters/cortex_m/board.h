/* SPDX-License-Identifier: BSD-3-Clause */
/* board.h - what start.c and the connection of a board need of each other. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Reports a fault and stops. Of the connection. */
_Noreturn void board_fail(const char* reason);

/* The largest size of the stack until now, in bytes. */
uint32_t board_stack_used(void);

#endif /* BOARD_H */
