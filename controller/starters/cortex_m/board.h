/* SPDX-License-Identifier: BSD-3-Clause */
/* board.h - what start.c and the connection of a board need of each other. */
#ifndef BOARD_H
#define BOARD_H

/* Reports a fault and stops. Of the connection. */
_Noreturn void board_fail(const char* reason);

#endif /* BOARD_H */
